// SPDX-License-Identifier: Apache-2.0
// DeviceTuning: compares the default with its neighbours, one after each pass, then with all
// changes together that have gained.
#include "gpu/tuning/device_tuning.h"

#include "core/text/format_text.h"
#include "gpu/gl/program_store.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

namespace ovc {

static double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

static double in_thousandths(double value) {
    return std::round(value * 1e3) / 1e3;
}

TuningLimits TuningLimits::thorough() {
    const double any = std::numeric_limits<double>::infinity();
    return {.seconds = any,
            .kind_seconds = any,
            .due_seconds = 0,
            .min_rays = 1,
            .comparison = {.rounds = 15, .worthwhile = 0.025},
            .trial_seconds = 0.01,
            .in_one_go = true};
}

DeviceTuning::DeviceTuning(const DeviceInfo& device, TuningFile file, LogSink log)
    : device_(device),
      file_(std::move(file)),
      log_(std::move(log)),
      defaults_(default_variants(device)),
      record_(file_.load().value_or(TuningRecord{})),
      variants_(defaults_) {
    for (size_t kind = 0; kind < RayKind::kCount; ++kind)
        if (const std::optional<KernelVariant>& chosen = record_.chosen[kind]) {
            variants_[RayKind::of(kind)] = *chosen;
            searches_[kind].over = true;
        }
}

std::shared_ptr<DeviceTuning> DeviceTuning::of(const DeviceInfo& device, LogSink log) {
    const std::string driver = device.vendor + "\n" + device.renderer + "\n" + device.version;
    const TuningFile file(ProgramStore::default_folder(), driver);
    return std::make_shared<DeviceTuning>(device, file, std::move(log));
}

bool DeviceTuning::is_due(const Search& search, size_t rays, const TuningLimits& limits) const {
    if (limits.in_one_go)
        return !search.begun; // once in a process, whatever was kept
    return !search.over && rays >= limits.min_rays && search.kernel_seconds >= limits.due_seconds &&
           record_.seconds < limits.seconds;
}

std::optional<VariantComparison> DeviceTuning::compare_with_default(RayKind kind,
                                                                    const KernelVariant& variant,
                                                                    const TuningLimits& limits,
                                                                    VariantTrials& trials) {
    return compare(defaults_[kind], variant, limits.comparison,
                   [&](const KernelVariant& v) { return trials.time(v); });
}

/// Whether there is time for another candidate. As much again is left, because a compiler's
/// time and what else the machine does are not known before.
bool DeviceTuning::is_time(const Search& search, const TuningLimits& limits) const {
    const double step = 2 * std::max(longest_step_, search.compile_seconds);
    return record_.seconds + step <= limits.seconds &&
           (search.next == 0 || search.seconds + step <= limits.kind_seconds);
}

void DeviceTuning::after_pass(RayKind kind, const PassCost& pass, const TuningLimits& limits,
                              VariantTrials& trials) {
    Search& search = searches_[kind.number()];
    search.kernel_seconds += pass.kernel_seconds;
    search.compile_seconds = std::max(search.compile_seconds, pass.seconds - pass.kernel_seconds);
    if (!is_due(search, pass.rays, limits))
        return;
    double counted = now();
    const auto count = [&] {
        const double time = now(), more = time - std::exchange(counted, time);
        record_.seconds += more;
        search.seconds += more;
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
    const KernelVariant& base = defaults_[kind];
    const auto differs = [&](const KernelVariant& v) { // where a switch means nothing, it does not
        const bool packs = (kind.coherent && !kind.has_portals()) || !v.compute;
        return (packs || v.packets == base.packets) &&
               (kind.has_portals() || v.float_pairs == base.float_pairs);
    };
    for (const KernelVariant& variant : neighbours(base, device_, /* other_kernel= */ true))
        if (differs(variant) && trials.can_run(variant))
            search.candidates.push_back({variant});
}

/// Compares the next candidate, if there is time for that and the driver has compiled it.
DeviceTuning::Next DeviceTuning::go_on(RayKind kind, Search& search, const TuningLimits& limits,
                                       VariantTrials& trials) {
    if (search.next == search.candidates.size() || !is_time(search, limits))
        return Next::Decide;
    Candidate& candidate = search.candidates[search.next];
    const double before = now();
    if (!std::exchange(candidate.begun, true))
        trials.begin(candidate.variant);
    const bool is_ready = limits.in_one_go || trials.is_ready(candidate.variant);
    if (is_ready) {
        candidate.result = compare_with_default(kind, candidate.variant, limits, trials);
        tell(kind, candidate.variant, candidate.result);
        ++search.next;
    }
    candidate.seconds += now() - before;
    longest_step_ = std::max(longest_step_, candidate.seconds);
    return is_ready ? Next::Step : Next::Pass;
}

static bool gains(const std::optional<VariantComparison>& result) {
    return result && result->is_faster;
}

/// Returns the candidate that gained most, with all other switches that gained in its kernel;
/// nothing if none did.
std::optional<KernelVariant> DeviceTuning::all_changes_that_gain(const KernelVariant& base,
                                                                 const Search& search) {
    const Candidate* const best = best_of(search);
    if (!best)
        return {};
    KernelVariant all = best->variant;
    for (const Candidate& other : search.candidates)
        if (gains(other.result) && other.variant.compute == all.compute)
            all = with_changes(all, base, other.variant);
    all = with_changes(all, base, best->variant); // its own value of a switch stays
    return parse_variant(all.text()) ? all : best->variant;
}

const DeviceTuning::Candidate* DeviceTuning::best_of(const Search& search) {
    const Candidate* best = nullptr;
    for (const Candidate& candidate : search.candidates)
        if (gains(candidate.result) && (!best || candidate.result->ratio < best->result->ratio))
            best = &candidate;
    return best;
}

/// Chooses between the default, the best candidate, and all changes that gained together. Whatever
/// is to replace the default must be faster once more.
void DeviceTuning::finish(RayKind kind, Search& search, const TuningLimits& limits,
                          VariantTrials& trials) {
    if (search.next == 0) {
        say(log_, LogLevel::Info,
            format_text("kernel variants for {} are not measured: compiling one takes longer than "
                        "there is time; `overcast devices --tune` takes it",
                        kind.text()));
        return;
    }
    const KernelVariant& base = defaults_[kind];
    KernelVariant chosen = base;
    const auto try_again = [&](const KernelVariant& variant) {
        const auto again = compare_with_default(kind, variant, limits, trials);
        tell(kind, variant, again);
        return again;
    };
    if (const Candidate* const best = best_of(search)) {
        const std::optional<VariantComparison> alone = try_again(best->variant);
        if (gains(alone))
            chosen = best->variant;
        const KernelVariant all = *all_changes_that_gain(base, search);
        if (!(all == best->variant) && is_time(search, limits)) {
            const std::optional<VariantComparison> together = try_again(all);
            if (gains(together) && (!gains(alone) || together->ratio < alone->ratio))
                chosen = all;
        }
    }
    variants_[kind] = chosen;
    record_.chosen[kind.number()] = chosen;
    say(log_, LogLevel::Info,
        format_text("kernel variant for {}: {}{}", kind.text(), chosen.text(),
                    chosen == base ? ", the default" : ""));
}

void DeviceTuning::tell(RayKind kind, const KernelVariant& variant,
                        const std::optional<VariantComparison>& result) {
    const std::string outcome =
        result ? format_text("{} times the default's {} ms", in_thousandths(result->ratio),
                             in_thousandths(1e3 * result->base_seconds))
               : "cannot be used";
    say(log_, LogLevel::Info,
        format_text("kernel variant tried for {}: {}: {}", kind.text(), variant.text(), outcome));
}

} // namespace ovc
