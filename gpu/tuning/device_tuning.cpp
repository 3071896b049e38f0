// SPDX-License-Identifier: Apache-2.0
// DeviceTuning: compares the default with its neighbours, one after each pass, then with all
// changes together that have gained.
#include "gpu/tuning/device_tuning.h"

#include "core/system/stopwatch.h"
#include "core/text/format_text.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace ovc {

static double in_thousandths(double value) {
    return std::round(value * 1e3) / 1e3;
}

TuningLimits TuningLimits::thorough() {
    const double any = std::numeric_limits<double>::infinity();
    return {.seconds = any,
            .kind_seconds = any,
            .due_seconds = 0,
            .min_rays = 1,
            .rounds = 9,
            .trial_seconds = 0.01,
            .in_one_go = true};
}

DeviceTuning::DeviceTuning(const DeviceInfo& device, TuningFile file, LogSink log)
    : device_(device),
      file_(std::move(file)),
      log_(std::move(log)),
      default_(default_variant(device)),
      record_(file_.load().value_or(TuningRecord{})),
      variants_(default_) {
    for (size_t kind = 0; kind < RayKind::kCount; ++kind)
        if (const std::optional<KernelVariant>& chosen = record_.chosen[kind]) {
            variants_[RayKind::of(kind)] = *chosen;
            searches_[kind].over = true;
        }
}

bool DeviceTuning::is_due(const Search& search, size_t rays, const TuningLimits& limits) const {
    if (limits.in_one_go)
        return !search.begun; // once in a process, whatever was kept
    return !search.over && rays >= limits.min_rays && search.kernel_seconds >= limits.due_seconds &&
           record_.seconds < limits.seconds;
}

void DeviceTuning::after_pass(RayKind kind, size_t rays, double kernel_seconds,
                              const TuningLimits& limits, VariantTrials& trials) {
    Search& search = searches_[kind.number()];
    search.kernel_seconds += kernel_seconds;
    if (!is_due(search, rays, limits))
        return;
    const Stopwatch watch;
    const double before = search.seconds;
    const auto count = [&] {
        record_.seconds += before + watch.seconds() - search.seconds;
        search.seconds = before + watch.seconds();
    };
    if (!search.begun)
        begin(kind, search, trials);
    Next next = Next::Step;
    while (next == Next::Step) {
        next = go_on(kind, search, limits, trials);
        count();
    }
    if (next == Next::Decide) {
        search.over = true;
        finish(kind, search, limits, trials);
        count();
    }
    file_.keep(record_);
}

void DeviceTuning::begin(RayKind kind, Search& search, VariantTrials& trials) {
    search.begun = true;
    const auto differs = [&](const KernelVariant& v) { // packets are for coherent rays alone
        return kind.coherent || !v.compute || v.packets == default_.packets;
    };
    for (const KernelVariant& variant : neighbours(default_, device_, /* other_kernel= */ true))
        if (differs(variant) && trials.can_run(variant))
            search.candidates.push_back({variant});
}

/// Compares the next candidate, if there is time for that and the driver has compiled it.
DeviceTuning::Next DeviceTuning::go_on(RayKind kind, Search& search, const TuningLimits& limits,
                                       VariantTrials& trials) {
    const auto is_time = [&] {
        return record_.seconds + longest_step_ <= limits.seconds &&
               search.seconds + longest_step_ <= limits.kind_seconds;
    };
    if (search.next == search.candidates.size() || !is_time())
        return Next::Decide;
    Candidate& candidate = search.candidates[search.next];
    const Stopwatch watch;
    if (!std::exchange(candidate.begun, true))
        trials.begin(candidate.variant);
    const bool is_ready = limits.in_one_go || trials.is_ready(candidate.variant);
    if (is_ready) {
        candidate.result = compare(default_, candidate.variant, limits.rounds,
                                   [&](const KernelVariant& v) { return trials.time(v); });
        tell(kind, candidate.variant, candidate.result);
        ++search.next;
    }
    candidate.seconds += watch.seconds();
    longest_step_ = std::max(longest_step_, candidate.seconds);
    return is_ready ? Next::Step : Next::Pass;
}

/// Returns the default with all switches that gained alone; nothing if none did.
std::optional<KernelVariant> DeviceTuning::all_changes_that_gain(const Search& search) const {
    std::vector<const Candidate*> gains;
    for (const Candidate& candidate : search.candidates)
        if (candidate.result && candidate.result->is_faster)
            gains.push_back(&candidate);
    if (gains.empty())
        return {};
    // Of two values of one switch the better comes last, and stays.
    std::ranges::sort(gains, std::greater(),
                      [](const Candidate* candidate) { return candidate->result->ratio; });
    KernelVariant all = default_;
    for (const Candidate* candidate : gains)
        all = with_changes(all, default_, candidate->variant);
    const bool fits = bool(parse_variant(all.text()));
    return fits ? all : gains.back()->variant;
}

void DeviceTuning::finish(RayKind kind, Search& search, const TuningLimits& limits,
                          VariantTrials& trials) {
    KernelVariant chosen = default_;
    if (std::optional<KernelVariant> all = all_changes_that_gain(search)) {
        const auto known = std::ranges::find(search.candidates, *all, &Candidate::variant);
        const bool is_compiled = known != search.candidates.end();
        if (!is_compiled && record_.seconds + longest_step_ > limits.seconds)
            all = std::ranges::min_element(search.candidates, {}, [](const Candidate& c) {
                      return c.result && c.result->is_faster ? c.result->ratio : 2.0;
                  })->variant;
        const std::optional<Comparison> again =
            compare(default_, *all, limits.rounds,
                    [&](const KernelVariant& v) { return trials.time(v); });
        tell(kind, *all, again);
        if (again && again->is_faster)
            chosen = *all;
    }
    variants_[kind] = chosen;
    record_.chosen[kind.number()] = chosen;
    say(log_, LogLevel::Info,
        format_text("kernel variant for {}: {}{}", kind.text(), chosen.text(),
                    chosen == default_ ? ", the default" : ""));
}

void DeviceTuning::tell(RayKind kind, const KernelVariant& variant,
                        const std::optional<Comparison>& result) {
    const std::string outcome =
        result ? format_text("{} times the default's {} ms", in_thousandths(result->ratio),
                             in_thousandths(1e3 * result->base_seconds))
               : "cannot be used";
    say(log_, LogLevel::Info,
        format_text("kernel variant tried for {}: {}: {}", kind.text(), variant.text(), outcome));
}

} // namespace ovc
