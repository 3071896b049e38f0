// SPDX-License-Identifier: Apache-2.0
// Spreads the rays of a call, deals them out in blocks, and gathers the answers.
#include "host/ranks/shared_calls.h"

#include "core/file/checksum.h"
#include "core/file/value_bytes.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <map>

namespace ovc {
namespace {

/// Rays are dealt out in blocks: neighbours stay together, and all ranks get some from everywhere.
constexpr size_t kBlock = 4096;
/// So many sets of rays are kept for calls to come.
constexpr size_t kMaxKept = 8;

enum class CallKind : uint8_t { Nearest, Any, End };

/// A call, as it is told to the other ranks.
struct Call {
    CallKind kind = CallKind::End;
    uint32_t backend = 0;
    uint64_t key = 0; // of the rays
    bool has_rays = false;
    std::vector<Ray> rays; // of all ranks; where has_rays, as the next
    std::vector<TriangleId> skip;
};

RankBytes bytes_of_call(const Call& call) {
    ByteWriter writer;
    writer(call.kind, call.backend, call.key, call.has_rays, uint64_t(call.rays.size()),
           uint64_t(call.skip.size()));
    const Bytes head = writer.bytes();
    const auto rays = std::as_bytes(std::span(call.rays)),
               skip = std::as_bytes(std::span(call.skip));
    RankBytes bytes(head.begin(), head.end());
    bytes.insert(bytes.end(), rays.begin(), rays.end());
    bytes.insert(bytes.end(), skip.begin(), skip.end());
    return bytes;
}

Call call_of(std::span<const std::byte> bytes) {
    Call call;
    uint64_t rays = 0, skip = 0;
    constexpr size_t kHead = sizeof(call.kind) + sizeof(call.backend) + sizeof(call.key) + 1 + 16;
    ByteReader(bytes.first(kHead))(call.kind, call.backend, call.key, call.has_rays, rays, skip);
    call.rays.resize(rays);
    call.skip.resize(skip);
    const auto rest = bytes.subspan(kHead);
    assert(rest.size() == rays * sizeof(Ray) + skip * sizeof(TriangleId));
    if (rays)
        std::memcpy(static_cast<void*>(call.rays.data()), rest.data(), rays * sizeof(Ray));
    if (skip)
        std::memcpy(call.skip.data(), rest.data() + rays * sizeof(Ray), skip * sizeof(TriangleId));
    return call;
}

/// The rays of a call that are a rank's part.
struct Part {
    std::vector<Ray> rays;
    std::vector<TriangleId> skip;

    Part(const Ranks& ranks, std::span<const Ray> all, std::span<const TriangleId> skip_all) {
        for (size_t i = ranks.rank() * kBlock; i < all.size(); i += ranks.count() * kBlock) {
            const size_t count = std::min(kBlock, all.size() - i);
            rays.insert(rays.end(), all.begin() + ptrdiff_t(i), all.begin() + ptrdiff_t(i + count));
            if (!skip_all.empty())
                skip.insert(skip.end(), skip_all.begin() + ptrdiff_t(i),
                            skip_all.begin() + ptrdiff_t(i + count));
        }
    }
};

/// Answers the part, as bytes behind one for its kind: 0, or 1 and the sentence of an error.
RankBytes answers_of(Backend& backend, CallKind kind, const Part& part) {
    const size_t size = kind == CallKind::Any ? 1 : sizeof(Hit);
    RankBytes bytes(1 + part.rays.size() * size);
    Result<Done> done = Done{};
    if (kind == CallKind::Any) {
        std::vector<uint8_t> occluded(part.rays.size());
        done = backend.occluded(part.rays, part.skip, occluded);
        std::memcpy(bytes.data() + 1, occluded.data(), occluded.size());
    } else {
        std::vector<Hit> hits(part.rays.size());
        done = backend.intersect(part.rays, part.skip, hits);
        std::memcpy(bytes.data() + 1, hits.data(), hits.size() * sizeof(Hit));
    }
    if (done)
        return bytes;
    const auto sentence = std::as_bytes(std::span(done.error().message));
    bytes.assign(1, std::byte(1));
    bytes.insert(bytes.end(), sentence.begin(), sentence.end());
    return bytes;
}

class SharedBackend final : public Backend {
public:
    SharedBackend(const Ranks& ranks, std::unique_ptr<Backend> backend, uint32_t number)
        : ranks_(ranks), backend_(std::move(backend)), number_(number) {}

    Result<Done> intersect(std::span<const Ray> rays, const Exclusions& without,
                           std::span<Hit> hits) override {
        return call<Hit>(CallKind::Nearest, rays, without, hits);
    }
    Result<Done> occluded(std::span<const Ray> rays, const Exclusions& without,
                          std::span<uint8_t> occluded) override {
        return call<uint8_t>(CallKind::Any, rays, without, occluded);
    }
    ovc_statistics statistics() const override { return backend_->statistics(); }
    std::string renderer() const override { return backend_->renderer(); }

private:
    template <class Answer>
    Result<Done> call(CallKind kind, std::span<const Ray> rays, const Exclusions& without,
                      std::span<Answer> answers) {
        if (!without.after.empty() || !without.sieves.pass_all())
            return Error{"several processes share calls of plain rays alone"};
        const Part* const mine = tell(kind, rays, without.skip);
        if (!mine)
            return Error{"a rank is lost"};
        const auto all = ranks_.gather(answers_of(*backend_, kind, *mine), goes_on_always);
        if (!all)
            return all.error();
        for (uint32_t rank = 0; rank < ranks_.count(); ++rank) {
            const RankBytes& bytes = (*all)[rank];
            if (bytes.front() != std::byte(0))
                return Error{
                    ranks_.name_of(rank) + ": " +
                    std::string(reinterpret_cast<const char*>(&bytes[1]), bytes.size() - 1)};
            const std::byte* from = bytes.data() + 1;
            for (size_t i = rank * kBlock; i < answers.size(); i += ranks_.count() * kBlock) {
                const size_t count = std::min(kBlock, answers.size() - i);
                std::memcpy(static_cast<void*>(&answers[i]), from, count * sizeof(Answer));
                from += count * sizeof(Answer);
            }
        }
        return Done{};
    }

    /// Tells the others of the call, and returns the part of this rank; null where one is lost.
    const Part* tell(CallKind kind, std::span<const Ray> rays, std::span<const TriangleId> skip) {
        Checksum sum;
        sum.add(std::as_bytes(rays));
        sum.add(std::as_bytes(skip));
        Call call{.kind = kind, .backend = number_, .key = sum.value()};
        const auto known = parts_.find(call.key);
        call.has_rays = known == parts_.end();
        if (call.has_rays) {
            call.rays.assign(rays.begin(), rays.end());
            call.skip.assign(skip.begin(), skip.end());
        }
        if (!ranks_.spread(bytes_of_call(call), goes_on_always))
            return nullptr;
        if (!call.has_rays)
            return &known->second;
        if (parts_.size() == kMaxKept) // as serve_calls() does
            parts_.clear();
        return &parts_.emplace(call.key, Part(ranks_, rays, skip)).first->second;
    }

    const Ranks& ranks_;
    const std::unique_ptr<Backend> backend_;
    const uint32_t number_;
    std::map<uint64_t, Part> parts_; // by the keys of their calls
};

} // namespace

std::unique_ptr<Backend> make_shared_backend(const Ranks& ranks, std::unique_ptr<Backend> backend,
                                             uint32_t number) {
    return std::make_unique<SharedBackend>(ranks, std::move(backend), number);
}

Result<Done> serve_calls(const Ranks& ranks, std::span<const std::unique_ptr<Backend>> backends) {
    std::vector<std::map<uint64_t, Part>> parts(backends.size());
    while (true) {
        const Result<RankBytes> told = ranks.spread({}, goes_on_always);
        if (!told)
            return told.error();
        const Call call = call_of(*told);
        if (call.kind == CallKind::End)
            return Done{};
        std::map<uint64_t, Part>& known = parts.at(call.backend);
        if (call.has_rays) {
            if (known.size() == kMaxKept)
                known.clear();
            known.emplace(call.key, Part(ranks, call.rays, call.skip));
        }
        const RankBytes answers =
            answers_of(*backends[call.backend], call.kind, known.at(call.key));
        if (const auto sent = ranks.gather(answers, goes_on_always); !sent)
            return sent.error();
    }
}

Result<Done> end_calls(const Ranks& ranks) {
    const Result<RankBytes> told = ranks.spread(bytes_of_call(Call()), goes_on_always);
    return told ? Result<Done>(Done{}) : told.error();
}

} // namespace ovc
