// SPDX-License-Identifier: Apache-2.0
// The rows of calls that are submitted.
#include "tests/misuse/entries.h"

namespace ovc::test {
namespace {

/// Submits a ray into each cell, in both ways.
struct Submitted {
    explicit Submitted(Subject& s) {
        for (uint32_t cell = 0; cell < kCells; ++cell)
            rays.push_back(into_cell(cell, 2));
        results[0] =
            api().submit_intersect(s.field, rays.data(), kCells, hits.data(), nullptr, &tickets[0]);
        results[1] = api().submit_occluded(s.field, rays.data(), kCells, occluded.data(), nullptr,
                                           &tickets[1]);
    }
    ~Submitted() {
        for (ovc_ticket ticket : tickets)
            api().release(ticket);
    }
    Submitted(const Submitted&) = delete;

    ovc_result end() {
        for (int i = 0; i < 2; ++i)
            if (results[i] == OVC_OK)
                results[i] = api().wait(tickets[i]);
        for (uint32_t cell = 0; cell < kCells; ++cell)
            if (results[0] == OVC_OK && results[1] == OVC_OK &&
                (!is_in_cell(hits[cell], cell, 2) || !occluded[cell]))
                return OVC_ERROR_INTERNAL;
        return results[0] != OVC_OK ? results[0] : results[1];
    }

    std::vector<ovc_ray> rays;
    std::vector<ovc_hit> hits{kCells};
    std::vector<uint8_t> occluded = std::vector<uint8_t>(kCells);
    ovc_ticket tickets[2] = {};
    ovc_result results[2];
};

ovc_result use_submitted(Subject& s) {
    return Submitted(s).end();
}
Misuses misuse_submit_intersect(Subject& s) {
    Wrong wrong(s);
    const ovc_ray ray = into_cell(0, 1);
    ovc_hit hit;
    ovc_ticket ticket;
    ovc_query unsized{};
    const auto submit = [&](ovc_scene to, const ovc_ray* rays, ovc_hit* hits,
                            const ovc_query* query, ovc_ticket* made) {
        return api().submit_intersect(to, rays, 1, hits, query, made);
    };
    wrong.without_device("scene NULL", submit(nullptr, &ray, &hit, nullptr, &ticket));
    wrong.argument("rays NULL", submit(s.field, nullptr, &hit, nullptr, &ticket));
    wrong.argument("hits NULL", submit(s.field, &ray, nullptr, nullptr, &ticket));
    wrong.argument("ticket NULL", submit(s.field, &ray, &hit, nullptr, nullptr));
    wrong.argument("struct_size 0", submit(s.field, &ray, &hit, &unsized, &ticket));
    wrong.state("before commit", submit(s.empty, &ray, &hit, nullptr, &ticket));
    return wrong.found();
}
Misuses misuse_submit_occluded(Subject& s) {
    Wrong wrong(s);
    const ovc_ray ray = into_cell(0, 1);
    uint8_t answer;
    ovc_ticket ticket;
    const auto submit = [&](ovc_scene to, const ovc_ray* rays, uint8_t* answers, ovc_ticket* made) {
        return api().submit_occluded(to, rays, 1, answers, nullptr, made);
    };
    wrong.without_device("scene NULL", submit(nullptr, &ray, &answer, &ticket));
    wrong.argument("rays NULL", submit(s.field, nullptr, &answer, &ticket));
    wrong.argument("occluded NULL", submit(s.field, &ray, nullptr, &ticket));
    wrong.argument("ticket NULL", submit(s.field, &ray, &answer, nullptr));
    wrong.state("before commit", submit(s.empty, &ray, &answer, &ticket));
    return wrong.found();
}

/// Returns a ticket that is released already.
ovc_ticket late(Subject& s) {
    return Submitted(s).tickets[0];
}

Misuses misuse_wait(Subject& s) {
    Wrong wrong(s);
    wrong.without_device("ticket NULL", api().wait(nullptr));
    wrong.without_device("released", api().wait(late(s)));
    return wrong.found();
}

ovc_result use_poll(Subject& s) {
    Submitted submitted(s);
    uint32_t done = 7;
    double progress = -1;
    const ovc_result polled = api().poll(submitted.tickets[0], &done, &progress);
    const ovc_result ended = submitted.end();
    if (polled != OVC_OK || ended != OVC_OK)
        return polled != OVC_OK ? polled : ended;
    return done <= 1 && progress >= 0 && progress <= 1 ? OVC_OK : OVC_ERROR_INTERNAL;
}
Misuses misuse_poll(Subject& s) {
    Wrong wrong(s);
    uint32_t done;
    const Submitted submitted(s);
    wrong.without_device("ticket NULL", api().poll(nullptr, &done, nullptr));
    wrong.without_device("released", api().poll(late(s), &done, nullptr));
    if (submitted.tickets[0])
        wrong.argument("done NULL", api().poll(submitted.tickets[0], nullptr, nullptr));
    return wrong.found();
}

ovc_result use_cancel(Subject& s) {
    Submitted submitted(s);
    const ovc_result cancelled = api().cancel(submitted.tickets[1]);
    const ovc_result ended = submitted.end();
    return ended == OVC_ERROR_CANCELLED ? cancelled : ended;
}
Misuses misuse_cancel(Subject& s) {
    Wrong wrong(s);
    wrong.without_device("ticket NULL", api().cancel(nullptr));
    wrong.without_device("released", api().cancel(late(s)));
    return wrong.found();
}

/// Releases a ticket twice, and NULL. Both do nothing.
ovc_result use_release(Subject& s) {
    api().release(nullptr);
    api().release(late(s));
    return use_submitted(s);
}
Misuses misuse_release(Subject& s) {
    Wrong wrong(s);
    wrong.without_device("used after it", api().wait(late(s)));
    return wrong.found();
}

constexpr Entry kTicketEntries[] = {
    OVC_ENTRY(submit_intersect, use_submitted, misuse_submit_intersect),
    OVC_ENTRY(submit_occluded, use_submitted, misuse_submit_occluded),
    OVC_ENTRY(wait, use_submitted, misuse_wait),
    OVC_ENTRY(poll, use_poll, misuse_poll),
    OVC_ENTRY(cancel, use_cancel, misuse_cancel),
    OVC_ENTRY(release, use_release, misuse_release),
};

} // namespace

std::span<const Entry> ticket_entries() {
    return kTicketEntries;
}

} // namespace ovc::test
