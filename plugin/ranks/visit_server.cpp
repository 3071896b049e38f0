// SPDX-License-Identifier: Apache-2.0
// Joins the visits that wait to batches, traces these, and cuts the answers up again.
#include "plugin/ranks/visit_server.h"

#include "core/system/blocked_signals.h"
#include "core/system/caught_error.h"
#include "plugin/ranks/visit_arrays.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <iterator>
#include <optional>

namespace ovc {

/// A batch has so many rays a thread at most, unless one message has more: passes over as many cost
/// what their rays do, and what comes from other ranks meanwhile does not wait for long.
static constexpr size_t kMaxRaysAThread = size_t(1) << 13;

/// The visits of several messages as a call takes them. A single message's rays stay where they
/// are; those of several are copied, into arrays that keep their memory from batch to batch.
struct VisitServer::Batch {
    std::span<const Ray> rays;
    Exclusions without;

    void fill(Messages messages) {
        size_t count = 0;
        uint32_t arrays = 0;
        for (const Received* received : messages) {
            count += received->message.head().count;
            arrays |= received->message.head().arrays;
        }
        if (messages.size() == 1) {
            const VisitArrays visits(messages[0]->message);
            show(visits.rays, visits.skip, visits.masks, visits.after.size());
            set_after(visits, 0);
            return;
        }
        rays_.resize(count);
        skip_.resize(arrays & VisitArrays::kHasSkip ? count : 0);
        masks_.resize(arrays & VisitArrays::kHasMasks ? count : 0);
        show(rays_, skip_, masks_, arrays & VisitArrays::kHasAfter ? count : 0);
        size_t first = 0;
        for (const Received* received : messages) {
            const VisitArrays visits(received->message);
            std::ranges::copy(visits.rays, rays_.begin() + ptrdiff_t(first));
            put(visits.skip, TriangleId(), first, visits.rays.size(), skip_);
            put(visits.masks, 0u, first, visits.rays.size(), masks_);
            set_after(visits, first);
            first += visits.rays.size();
        }
    }

private:
    void show(std::span<const Ray> all, std::span<const TriangleId> skip,
              std::span<const uint32_t> masks, size_t afters) {
        rays = all;
        after_.assign(afters, kBeforeAll);
        without = Exclusions(skip, after_);
        without.sieves.masks = masks;
    }
    void set_after(const VisitArrays& visits, size_t first) {
        for (size_t i = 0; i < visits.after.size(); ++i)
            after_[first + i] = {visits.after[i].t, 0, 0, visits.after[i].id};
    }
    /// Copies a message's array, or `other` for each of its visits where it has none.
    template <class T>
    static void put(std::span<T> array, const T& other, size_t first, size_t count,
                    std::vector<T>& all) {
        if (all.empty())
            return;
        const auto to = all.begin() + ptrdiff_t(first);
        if (array.empty())
            std::fill_n(to, count, other);
        else
            std::ranges::copy(array, to);
    }

    std::vector<Ray> rays_;
    std::vector<TriangleId> skip_;
    std::vector<Hit> after_;
    std::vector<uint32_t> masks_;
};

VisitServer::VisitServer(Structure& local, Transport& transport, LoopThreads* threads)
    : local_(local), transport_(transport), threads_(threads), batch_(std::make_unique<Batch>()) {
    const BlockedSignals blocked;
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

VisitServer::~VisitServer() {
    thread_.request_stop();
    transport_.visits.wake();
}

/// Those that wait for an answer learn of an error from serve(). Where even that fails, for want of
/// memory, no answer would ever come.
void VisitServer::run(const std::stop_token& stop) noexcept {
    try {
        serve_until(stop);
    } catch (...) {
        transport_.give_up(caught_error());
    }
}

void VisitServer::serve_until(const std::stop_token& stop) {
    std::optional<LoopThreads::Scope> scope;
    if (threads_)
        scope.emplace(*threads_);
    std::vector<Received> waiting;
    while (!stop.stop_requested()) {
        const std::chrono::milliseconds patience(waiting.empty() ? 50 : 0);
        std::ranges::move(transport_.visits.take(patience), std::back_inserter(waiting));
        // Others have waited for their rays to come here already.
        std::ranges::stable_partition(
            waiting, [&](const Received& received) { return received.from != transport_.rank(); });
        is_idle_ = waiting.empty();
        if (!waiting.empty())
            serve_first(waiting);
        is_idle_ = waiting.empty();
    }
}

/// Serves a batch of the first messages, those that ask for the same as the first of all, and
/// removes them.
void VisitServer::serve_first(std::vector<Received>& waiting) {
    const MessageKind kind = waiting.front().message.kind();
    const size_t max_rays = kMaxRaysAThread * thread_count();
    std::vector<Received> some;
    size_t rays = 0;
    std::erase_if(waiting, [&](Received& received) {
        const size_t more = received.message.head().count;
        const bool is_taken =
            received.message.kind() == kind && (some.empty() || rays + more <= max_rays);
        if (is_taken) {
            rays += more;
            served_ += received.from == transport_.rank() ? 0 : more;
            some.push_back(std::move(received));
        }
        return is_taken;
    });
    serve(some, kind);
}

void VisitServer::serve(std::span<const Received> all, MessageKind kind) {
    std::vector<const Received*> some;
    for (const Received& received : all)
        some.push_back(&received);
    const std::lock_guard lock(local_mutex_);
    try {
        if (has_left_soup_)
            return fail(some, {"the scene has changed there, before all ranks had their answers",
                               ErrorKind::InvalidState});
        batch_->fill(some);
        if (kind == MessageKind::AnyVisits)
            answer<uint8_t>(some, MessageKind::Occlusions, [&](std::span<uint8_t> occluded) {
                return local_.occluded(batch_->rays, batch_->without, occluded);
            });
        else
            answer<Hit>(some, MessageKind::Hits, [&](std::span<Hit> hits) {
                return local_.intersect(batch_->rays, batch_->without, hits);
            });
    } catch (...) {
        fail(some, caught_error());
    }
}

/// Sends the answers that trace(span) writes to where their rays came from.
template <class Answer, class Trace>
void VisitServer::answer(Messages messages, MessageKind kind, Trace&& trace) {
    std::vector<Message> answers;
    for (const Received* received : messages) {
        const MessageHead asked = received->message.head();
        answers.push_back(
            Message({kind, asked.call, asked.number, asked.count}, asked.count * sizeof(Answer)));
    }
    std::vector<Answer> room(messages.size() == 1 ? 0 : batch_->rays.size());
    const auto all = messages.size() == 1 ? answers[0].items<Answer>() : std::span<Answer>(room);
    if (const Result<Done> done = trace(all); !done)
        return fail(messages, done.error());
    size_t first = 0;
    for (size_t i = 0; i < messages.size(); ++i) {
        const auto items = answers[i].items<Answer>();
        if (messages.size() > 1)
            std::ranges::copy(all.subspan(first, items.size()), items.begin());
        first += items.size();
        transport_.send(messages[i]->from, std::move(answers[i]));
    }
}

void VisitServer::fail(Messages messages, const Error& error) {
    const std::string told = text_of_error(error);
    for (const Received* received : messages) {
        const MessageHead asked = received->message.head();
        transport_.send(received->from, Message({MessageKind::Failure, asked.call, asked.number},
                                                std::span<const char>(told)));
    }
}

} // namespace ovc
