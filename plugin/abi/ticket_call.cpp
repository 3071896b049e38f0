// SPDX-License-Identifier: Apache-2.0
// Tickets: the host's handles of calls that it has submitted.
#include "plugin/abi/ticket_call.h"

#include "core/text/format_text.h"
#include "plugin/abi/submission.h"

#include <cassert>
#include <optional>

namespace ovc {
namespace {

/// Runs the submission in its turn, on the thread of the scene's queue.
void do_in_turn(ovc_scene scene, Submission& submission) {
    const std::lock_guard turn(scene->turn);
    if (!submission.begin())
        return;
    Submission::Outcome outcome;
    outcome.result = guard(outcome, [&] {
        const LoopThreads::Scope threads(scene->device->loops);
        trace(submission.call(), committed(scene, submission.call().name), &submission);
    });
    submission.end(std::move(outcome));
}

/// Submits the call that check() makes of the arguments.
template <class Check>
ovc_result submit(ovc_scene scene, const char* name, ovc_ticket* ticket, Check&& check) {
    if (ticket)
        *ticket = nullptr;
    const HostFloatMode mode;
    return beside_scene(scene, name, [&] {
        if (!ticket)
            invalid(format_text("{}: ticket is NULL", name));
        const RayCall call = check();
        const SingleRays::Call reading(scene->single_rays); // other threads wait to change it
        if (!reading.structure())
            not_committed(name);
        check_notes(call, *reading.structure());
        auto made = std::make_unique<ovc_ticket_t>();
        made->device = scene->device;
        made->scene = scene;
        made->submission = std::make_shared<Submission>(call, mode);
        if (!scene->submissions.submit(made->submission, [scene](Submission& submission) {
                do_in_turn(scene, submission);
            }))
            throw Failure{OVC_ERROR_INVALID_STATE,
                          format_text("{}: the scene is being destroyed", name)};
        ++scene->device->tickets;
        *ticket = made.release();
    });
}

/// Returns whether the handle is that of a ticket that is not released and belongs to this process,
/// not to the one that this was forked from. If not, it records a message for last_error(NULL).
bool is_ticket(ovc_ticket ticket, const char* call) {
    if (ticket && ticket->magic == kTicketMagic)
        return is_device(ticket->device, call);
    fail_without_device(OVC_ERROR_INVALID_ARGUMENT,
                        format_text("{}: ticket is NULL, released, or not a ticket", call));
    return false;
}

/// Runs body(submission) for a ticket that is not released.
template <class Body>
ovc_result on_ticket(ovc_ticket ticket, const char* call, Body&& body) {
    return beside_calls(ticket, call, is_ticket, [&] { body(*ticket->submission); });
}

} // namespace

ovc_result submit_intersect(ovc_scene scene, const ovc_ray* rays, size_t ray_count, ovc_hit* hits,
                            const ovc_query* query, ovc_ticket* ticket) {
    return submit(scene, "submit_intersect", ticket,
                  [&] { return nearest_call("submit_intersect", rays, ray_count, hits, query); });
}

ovc_result submit_occluded(ovc_scene scene, const ovc_ray* rays, size_t ray_count,
                           uint8_t* occluded, const ovc_query* query, ovc_ticket* ticket) {
    return submit(scene, "submit_occluded", ticket, [&] {
        return occlusion_call("submit_occluded", rays, ray_count, occluded, query);
    });
}

ovc_result wait(ovc_ticket ticket) {
    return on_ticket(ticket, "wait", [&](Submission& submission) {
        std::optional<SharedBudget::Waiting> waiting;
        if (in_stream)
            waiting.emplace(ticket->device->gl->budget());
        const Submission::Outcome outcome = submission.wait([&] {
            if (ticket->scene->streaming == std::this_thread::get_id())
                throw Failure{OVC_ERROR_INVALID_STATE,
                              "wait: called from within the stream of the ticket's scene, which it "
                              "would wait for"};
            if (waiting)
                check_budget(ticket->scene, *waiting, "wait");
        });
        if (outcome.result != OVC_OK)
            throw Failure{outcome.result, outcome.message};
    });
}

ovc_result poll(ovc_ticket ticket, uint32_t* done, double* progress) {
    return on_ticket(ticket, "poll", [&](Submission& submission) {
        if (!done)
            invalid("poll: done is NULL");
        *done = submission.done();
        if (progress)
            *progress = submission.progress();
    });
}

ovc_result cancel(ovc_ticket ticket) {
    return on_ticket(ticket, "cancel", [](Submission& submission) { submission.cancel(); });
}

void release(ovc_ticket ticket) {
    uint32_t alive = kTicketMagic;
    if (!is_ticket(ticket, "release") || in_host_function ||
        !ticket->magic.compare_exchange_strong(alive, kDestroyed))
        return;
    ticket->submission->cancel();
    ticket->submission->wait_until_done();
    ticket->calls.wait_until_none();
    ovc_device device = ticket->device;
    device->released.add(std::unique_ptr<ovc_ticket_t>(ticket));
    --device->tickets;
}

} // namespace ovc
