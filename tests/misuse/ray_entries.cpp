// SPDX-License-Identifier: Apache-2.0
// The rows of rays: batches and streams.
#include "tests/misuse/entries.h"

namespace ovc::test {
namespace {

ovc_result use_rays(Subject& s) {
    return field_answers(s.field) ? OVC_OK : OVC_ERROR_INTERNAL;
}
Misuses misuse_intersect(Subject& s) {
    Wrong wrong(s);
    const ovc_ray ray = into_cell(0, 1);
    ovc_hit hit;
    ovc_query unsized{};
    wrong.without_device("scene NULL", api().intersect(nullptr, &ray, 1, &hit, nullptr));
    wrong.argument("rays NULL", api().intersect(s.field, nullptr, 1, &hit, nullptr));
    wrong.argument("hits NULL", api().intersect(s.field, &ray, 1, nullptr, nullptr));
    wrong.argument("struct_size 0", api().intersect(s.field, &ray, 1, &hit, &unsized));
    wrong.state("before commit", api().intersect(s.empty, &ray, 1, &hit, nullptr));
    ovc_ray rays[4] = {ray, ray, ray, ray};
    auto* const within = reinterpret_cast<ovc_hit*>(&rays[1]);
    wrong.argument("hits over rays", api().intersect(s.field, rays, 4, within, nullptr));
    ovc_hit hits[4];
    auto noted = sized<ovc_query>();
    noted.leaf = reinterpret_cast<uint32_t*>(&hits[3]);
    wrong.argument("notes over hits", api().intersect(s.field, rays, 4, hits, &noted));
    uint32_t notes[5];
    noted.leaf = notes;
    noted.passes = notes + 1;
    wrong.argument("notes over notes", api().intersect(s.field, rays, 4, hits, &noted));
    noted = sized<ovc_query>();
    noted.skip = reinterpret_cast<ovc_triangle*>(&hits[2]);
    wrong.argument("hits over skip", api().intersect(s.field, rays, 4, hits, &noted));
    noted = sized<ovc_query>();
    noted.after = &hits[1];
    wrong.argument("hits over after", api().intersect(s.field, rays, 3, hits, &noted));
    noted = sized<ovc_query>();
    noted.masks = reinterpret_cast<uint32_t*>(&hits[2]);
    wrong.argument("hits over masks", api().intersect(s.field, rays, 4, hits, &noted));
    return wrong.found();
}
ovc_result use_all_hits(Subject& s) {
    for (uint32_t cell = 0; cell < kCells; ++cell) {
        const ovc_ray ray = into_cell(cell, 3);
        ovc_hit hits[2]{};
        uint64_t count = 0;
        const ovc_result found = api().all_hits(s.field, &ray, 1, 2, hits, &count, nullptr);
        if (found != OVC_OK)
            return found;
        if (!is_in_cell(hits[0], cell, 3) || count != 1 || hits[1].mesh != OVC_NONE)
            return OVC_ERROR_INTERNAL;
    }
    return OVC_OK;
}
Misuses misuse_all_hits(Subject& s) {
    Wrong wrong(s);
    const ovc_ray ray = into_cell(0, 1);
    ovc_hit hits[4];
    uint64_t count = 0;
    ovc_query unsized{};
    uint32_t note = 0;
    auto noted = sized<ovc_query>();
    noted.leaf = &note;
    const auto ask = [&](ovc_scene scene, const ovc_ray* rays, size_t max_hits, ovc_hit* to,
                         uint64_t* counts, const ovc_query* query) {
        return api().all_hits(scene, rays, 1, max_hits, to, counts, query);
    };
    wrong.without_device("scene NULL", ask(nullptr, &ray, 4, hits, &count, nullptr));
    wrong.argument("rays NULL", ask(s.field, nullptr, 4, hits, &count, nullptr));
    wrong.argument("hits NULL", ask(s.field, &ray, 4, nullptr, &count, nullptr));
    wrong.argument("nothing to write", ask(s.field, &ray, 0, hits, nullptr, nullptr));
    wrong.argument("too many hits", ask(s.field, &ray, ~size_t(0) / 8, hits, &count, nullptr));
    wrong.argument("struct_size 0", ask(s.field, &ray, 4, hits, &count, &unsized));
    wrong.argument("notes", ask(s.field, &ray, 4, hits, &count, &noted));
    wrong.argument("counts over hits",
                   ask(s.field, &ray, 4, hits, reinterpret_cast<uint64_t*>(&hits[3]), nullptr));
    wrong.state("before commit", ask(s.empty, &ray, 4, hits, &count, nullptr));
    return wrong.found();
}
Misuses misuse_occluded(Subject& s) {
    Wrong wrong(s);
    const ovc_ray ray = into_cell(0, 1);
    uint8_t answer;
    uint32_t note;
    ovc_query unsized{};
    auto noted = sized<ovc_query>();
    noted.leaf = &note;
    wrong.without_device("scene NULL", api().occluded(nullptr, &ray, 1, &answer, nullptr));
    wrong.argument("rays NULL", api().occluded(s.field, nullptr, 1, &answer, nullptr));
    wrong.argument("occluded NULL", api().occluded(s.field, &ray, 1, nullptr, nullptr));
    wrong.argument("struct_size 0", api().occluded(s.field, &ray, 1, &answer, &unsized));
    wrong.argument("notes", api().occluded(s.field, &ray, 1, &answer, &noted));
    wrong.state("before commit", api().occluded(s.empty, &ray, 1, &answer, nullptr));
    ovc_ray rays[2] = {ray, ray};
    auto* const within = reinterpret_cast<uint8_t*>(rays) + 127;
    wrong.argument("answers over rays", api().occluded(s.field, rays, 2, within, nullptr));
    return wrong.found();
}

ovc_result use_single_rays(Subject& s) {
    for (uint32_t cell = 0; cell < kCells; ++cell) {
        const ovc_ray ray = into_cell(cell, 3);
        ovc_hit hit{};
        uint8_t occluded = 0;
        const ovc_result nearest = api().intersect1(s.field, &ray, &hit, nullptr);
        const ovc_result any = api().occluded1(s.field, &ray, &occluded, nullptr);
        if (nearest != OVC_OK || any != OVC_OK)
            return nearest != OVC_OK ? nearest : any;
        if (!is_in_cell(hit, cell, 3) || !occluded)
            return OVC_ERROR_INTERNAL;
    }
    return OVC_OK;
}
/// Misuses intersect1 or occluded1, which differ in the type of their answer.
template <class Answer>
Misuses misuse_single(Subject& s,
                      ovc_result (*call)(ovc_scene, const ovc_ray*, Answer*, const ovc_query*)) {
    Wrong wrong(s);
    const ovc_ray ray = into_cell(0, 1);
    Answer answer;
    ovc_query unsized{};
    wrong.without_device("scene NULL", call(nullptr, &ray, &answer, nullptr));
    wrong.argument("ray NULL", call(s.field, nullptr, &answer, nullptr));
    wrong.argument("answer NULL", call(s.field, &ray, nullptr, nullptr));
    wrong.argument("struct_size 0", call(s.field, &ray, &answer, &unsized));
    wrong.state("before commit", call(s.empty, &ray, &answer, nullptr));
    return wrong.found();
}
Misuses misuse_intersect1(Subject& s) {
    return misuse_single(s, api().intersect1);
}
Misuses misuse_occluded1(Subject& s) {
    return misuse_single(s, api().occluded1);
}

/// The host of a stream. It pushes a ray into each cell, and counts right answers.
struct Streamer {
    Subject& subject;
    uint32_t pushed = 0;
    uint32_t right = 0;
    Misuses (*within)(Subject&, ovc_stream) = nullptr; // called once, within the stream
    Misuses misuses;
    ovc_stream stream = nullptr; // the handle, to be misused later

    static int more(void* user, ovc_stream stream, size_t) {
        Streamer& self = *static_cast<Streamer*>(user);
        self.stream = stream;
        if (self.pushed == kCells)
            return 0;
        if (self.within)
            self.misuses = self.within(self.subject, stream);
        for (uint64_t cell = 0; cell < kCells; ++cell) {
            const ovc_ray ray = into_cell(uint32_t(cell), 1);
            self.pushed += api().push(stream, &ray, &cell, 1, 0, nullptr) == OVC_OK;
        }
        return 0;
    }
    static int answered(void* user, ovc_stream, const ovc_stream_answers* answers) {
        Streamer& self = *static_cast<Streamer*>(user);
        for (size_t i = 0; i < answers->count; ++i)
            self.right += is_in_cell(answers->hits[i], uint32_t(answers->tokens[i]), 1);
        return 0;
    }
    ovc_stream_host host() {
        auto host = sized<ovc_stream_host>();
        host.user = this;
        host.more = more;
        host.answered = answered;
        return host;
    }
};

ovc_result use_stream(Subject& s) {
    Streamer streamer{s};
    const ovc_stream_host host = streamer.host();
    const ovc_result result = api().stream(s.field, &host);
    return streamer.right == kCells ? result : OVC_ERROR_INTERNAL;
}
Misuses misuse_stream(Subject& s) {
    Wrong wrong(s);
    Streamer streamer{s};
    const ovc_stream_host host = streamer.host();
    ovc_stream_host spoilt = host;
    wrong.without_device("scene NULL", api().stream(nullptr, &host));
    wrong.argument("host NULL", api().stream(s.field, nullptr));
    wrong.state("before commit", api().stream(s.empty, &host));
    spoilt.answered = nullptr;
    wrong.argument("answered NULL", api().stream(s.field, &spoilt));
    spoilt.struct_size = 0;
    wrong.argument("struct_size 0", api().stream(s.field, &spoilt));
    return wrong.found();
}

Misuses misuse_push_within(Subject& s, ovc_stream stream) {
    Wrong wrong(s);
    const ovc_ray ray = into_cell(0, 1);
    const uint64_t token = 0;
    uint32_t note;
    ovc_query unsized{};
    auto noted = sized<ovc_query>();
    noted.passes = &note;
    wrong.argument("rays NULL", api().push(stream, nullptr, &token, 1, 0, nullptr));
    wrong.argument("tokens NULL", api().push(stream, &ray, nullptr, 1, 0, nullptr));
    wrong.argument("any_hit 2", api().push(stream, &ray, &token, 1, 2, nullptr));
    wrong.argument("struct_size 0", api().push(stream, &ray, &token, 1, 0, &unsized));
    wrong.argument("notes", api().push(stream, &ray, &token, 1, 0, &noted));
    wrong.state("commit within a stream", api().commit(s.field));
    // This is refused, because the stream would wait for itself.
    api().destroy_scene(s.field);
    return wrong.found();
}
Misuses misuse_push(Subject& s) {
    Wrong wrong(s);
    const ovc_ray ray = into_cell(0, 1);
    const uint64_t token = 0;
    Streamer streamer{s};
    streamer.within = misuse_push_within;
    const ovc_stream_host host = streamer.host();
    wrong.on_device("a stream goes on after what is refused", OVC_OK, api().stream(s.field, &host));
    wrong.on_device("and answers its rays", OVC_OK,
                    streamer.right == kCells ? OVC_OK : OVC_ERROR_INTERNAL);
    wrong.without_device("stream NULL", api().push(nullptr, &ray, &token, 1, 0, nullptr));
    wrong.without_device("after the stream",
                         api().push(streamer.stream, &ray, &token, 1, 0, nullptr));
    Misuses all = wrong.found();
    all.insert(all.end(), streamer.misuses.begin(), streamer.misuses.end());
    return all;
}

constexpr Entry kRayEntries[] = {
    OVC_ENTRY(intersect, use_rays, misuse_intersect),
    OVC_ENTRY(occluded, use_rays, misuse_occluded),
    OVC_ENTRY(intersect1, use_single_rays, misuse_intersect1),
    OVC_ENTRY(occluded1, use_single_rays, misuse_occluded1),
    OVC_ENTRY(all_hits, use_all_hits, misuse_all_hits),
    OVC_ENTRY(stream, use_stream, misuse_stream),
    OVC_ENTRY(push, use_stream, misuse_push),
};

} // namespace

std::span<const Entry> ray_entries() {
    return kRayEntries;
}

} // namespace ovc::test
