// SPDX-License-Identifier: Apache-2.0
// Runs a case of the stability suite batch by batch and scores the answers of each program.
#include "host/suites/stability/stability.h"

#include "core/system/stopwatch.h"
#include "host/suites/judge.h"
#include "kdtree/build.h"
#include "kdtree/traverse.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <limits>

namespace ovc {

namespace {

constexpr size_t kCaseBatch = 1 << 17;
constexpr size_t kWarmUp = 64;

uint64_t difference(uint64_t a, uint64_t b) {
    return a > b ? a - b : b - a;
}

bool same_bits(const Hit& a, const Hit& b) {
    return std::memcmp(&a, &b, sizeof(Hit)) == 0;
}

double relative_error(double t, double truth) {
    if (t == truth)
        return 0;
    return truth == 0 ? std::numeric_limits<double>::infinity()
                      : std::abs(t - truth) / std::abs(truth);
}

enum class Claim { EveryBit, Triangle };

/// A batch of rays and the reference's hits.
struct Batch {
    AimedRays set;
    std::vector<Hit> truth;

    TriangleId skip(size_t i) const { return set.skip.empty() ? TriangleId{} : set.skip[i]; }
};

void score(const Batch& batch, const Soup& soup, bool closed, std::span<const Hit> answers,
           Claim claim, StabilityScore& total) {
    assert(answers.size() == batch.truth.size());
    for (size_t i = 0; i < answers.size(); ++i) {
        const Hit &answer = answers[i], &truth = batch.truth[i];
        const bool same =
            claim == Claim::EveryBit ? same_bits(answer, truth) : answer.id == truth.id;
        if (!answer.is_hit() && (closed || truth.is_hit()))
            ++total.leaks;
        else if (!same && claim == Claim::Triangle && answer.is_hit() && truth.is_hit() &&
                 answer.id != batch.skip(i) &&
                 is_tied(batch.set.rays[i], soup.triangle(answer.id), soup.triangle(truth.id)))
            ++total.tied;
        else
            total.wrong += !same;
        if (answer.is_hit() && truth.is_hit())
            total.t_error = std::max(total.t_error, relative_error(answer.t, truth.t));
    }
}

struct Peer {
    std::unique_ptr<Backend> backend;
    std::optional<StabilityScore> StabilityResult::*score;
};

/// One case while it runs: the soup and all programs that answer.
class CaseRun {
public:
    CaseRun(const StabilityCase& stability_case, const StabilityOptions& options)
        : case_(stability_case),
          options_(options),
          soup_(case_.soup()),
          tree_(build_kd_tree(soup_)) {
        result_.name = case_.name;
        result_.closed = case_.closed;
        result_.time_as = case_.time_as;
        result_.bar = case_.bar;
        result_.triangles = soup_.triangle_count();
        Dropped dropped;
        hittable_triangles(soup_, &dropped, nullptr);
        result_.dropped = dropped.total();
    }

    Result<StabilityResult> all(const LogSink& log) {
        if (const Result<Done> opened = open(log); !opened)
            return opened.error();
        size_t left = case_.rays * options_.times;
        for (uint64_t number = 0; left > 0; ++number) {
            const size_t count = std::min(left, kCaseBatch);
            if (const Result<Done> done = ask(number, count); !done)
                return done.error();
            left -= count;
            if (options_.go_on && !options_.go_on(result_))
                break;
        }
        finish();
        return result_;
    }

private:
    Result<Done> open(const LogSink& log) {
        Result<std::unique_ptr<Backend>> certified = plugin(OVC_PRECISION_CERTIFIED, log);
        if (!certified)
            return certified.error();
        certified_ = std::move(*certified);
        result_.renderer = certified_->renderer();
        if (options_.peers)
            if (const Result<Done> opened = open_peers(log); !opened)
                return opened;
        return warm_up();
    }

    Result<Done> open_peers(const LogSink& log) {
        Result<std::unique_ptr<Backend>> fast = plugin(OVC_PRECISION_FAST, log);
        if (!fast)
            return fast.error();
        peers_.push_back({std::move(*fast), &StabilityResult::fast});
        // make_embree_backend() returns null where this program was built without Embree.
        for (const auto& [mode, score_of] :
             {std::pair(EmbreeMode::Robust, &StabilityResult::embree_robust),
              std::pair(EmbreeMode::Medium, &StabilityResult::embree_default)})
            if (Result<std::unique_ptr<Backend>> embree = make_embree_backend(soup_, mode); embree)
                peers_.push_back({std::move(*embree), score_of});
        return Done{};
    }

    Result<std::unique_ptr<Backend>> plugin(ovc_precision precision, const LogSink& log) const {
        BackendOptions options = options_.backend;
        if (options.kind == BackendKind::Auto)
            options.kind = BackendKind::TwoLevel; // so that no CPU backend takes its place
        if (options.kind == BackendKind::TwoLevel && options.kernel == OVC_KERNEL_AUTO &&
            options.kernel_variant.empty())
            options.kernel = OVC_KERNEL_COMPUTE; // nor the CPU the kernel's in small batches
        options.precision = precision;
        return make_backend(soup_, options, log);
    }

    /// The driver compiles with the first rays; they are neither timed nor counted.
    Result<Done> warm_up() {
        const AimedRays set = stability_rays(case_, soup_, 0, kWarmUp);
        std::vector<Hit> hits(set.rays.size());
        const Result<Done> done = certified_->intersect(set.rays, set.skip, hits);
        before_ = certified_->statistics();
        return done;
    }

    Result<Done> ask(uint64_t number, size_t count) {
        const Batch batch = make_batch(number, count);
        std::vector<Hit> answers(batch.truth.size());
        const Stopwatch watch;
        if (const Result<Done> done =
                certified_->intersect(batch.set.rays, batch.set.skip, answers);
            !done)
            return done;
        seconds_ += watch.seconds();
        result_.microseconds = 1e6 * seconds_ / double(result_.rays);
        const ovc_statistics after = certified_->statistics();
        result_.flagged += after.flagged - before_.flagged;
        result_.retraced += after.retraced - before_.retraced;
        score(batch, soup_, case_.closed, answers, Claim::EveryBit, result_.certified);
        if (const Result<Done> done = ask_occlusion(batch); !done)
            return done;
        before_ = certified_->statistics();
        return ask_peers(batch, answers);
    }

    Batch make_batch(uint64_t number, size_t count) {
        Batch batch{stability_rays(case_, soup_, number, count), {}};
        assert(batch.set.skip.empty() || batch.set.skip.size() == batch.set.rays.size());
        batch.truth.resize(batch.set.rays.size());
        intersect(tree_, soup_, batch.set.rays, batch.set.skip, batch.truth);
        result_.rays += batch.truth.size();
        for (size_t i = 0; i < batch.truth.size(); ++i) {
            result_.hits += batch.truth[i].is_hit();
            result_.invalid += !batch.set.rays[i].valid();
            result_.reference_leaks += case_.closed && !batch.truth[i].is_hit();
        }
        return batch;
    }

    Result<Done> ask_occlusion(const Batch& batch) {
        std::vector<uint8_t> occluded(batch.truth.size());
        const Result<Done> done = certified_->occluded(batch.set.rays, batch.set.skip, occluded);
        for (size_t i = 0; i < occluded.size(); ++i)
            result_.wrong_occlusions += bool(occluded[i]) != batch.truth[i].is_hit();
        return done;
    }

    Result<Done> ask_peers(const Batch& batch, std::span<Hit> answers) {
        for (const Peer& peer : peers_) {
            if (const Result<Done> done =
                    peer.backend->intersect(batch.set.rays, batch.set.skip, answers);
                !done)
                return done;
            std::optional<StabilityScore>& total = result_.*peer.score;
            if (!total)
                total.emplace();
            score(batch, soup_, case_.closed, answers, Claim::Triangle, *total);
        }
        return Done{};
    }

    void finish() {
        const ovc_statistics end = certified_->statistics();
        // Each ray was asked twice, nearest and occlusion, after the warm-up.
        uint64_t warm = 0;
        for (const Ray& ray : stability_rays(case_, soup_, 0, kWarmUp).rays)
            warm += !ray.valid();
        result_.miscounted =
            difference(end.invalid_rays, warm + 2 * result_.invalid) +
            difference(end.dropped_not_finite + end.dropped_degenerate, result_.dropped);
    }

    const StabilityCase& case_;
    const StabilityOptions& options_;
    Soup soup_;
    KdTree tree_;
    std::unique_ptr<Backend> certified_;
    std::vector<Peer> peers_;
    ovc_statistics before_{};
    double seconds_ = 0;
    StabilityResult result_;
};

} // namespace

AimedRays stability_rays(const StabilityCase& stability_case, const Soup& soup, uint64_t batch,
                         size_t count) {
    Random random(/* seed= */ 2006, batch);
    return stability_case.aim(soup, random, count);
}

Result<StabilityResult> run_stability_case(const StabilityCase& stability_case,
                                           const StabilityOptions& options, const LogSink& log) {
    return CaseRun(stability_case, options).all(log);
}

Result<std::vector<StabilityResult>>
run_stability(std::span<const StabilityCase> cases, const StabilityOptions& options,
              const LogSink& log, const std::function<void(const StabilityResult&)>& seen) {
    std::vector<StabilityResult> results;
    for (const StabilityCase& one : cases) {
        Result<StabilityResult> result = run_stability_case(one, options, log);
        if (!result)
            return Error{one.name + ": " + result.error().message};
        for (const StabilityResult& before : results)
            if (before.name == one.time_as)
                result->time_ratio = result->microseconds / before.microseconds;
        results.push_back(std::move(*result));
        seen(results.back());
        if (results.back().rays < one.rays * options.times)
            break;
    }
    return results;
}

} // namespace ovc
