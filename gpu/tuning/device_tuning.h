// SPDX-License-Identifier: Apache-2.0
// DeviceTuning: finds the fastest kernel variant of a device for each kind of rays, beside a
// scene's own passes and within a limit of time (docs/decisions/0032).
#pragma once

#include "core/system/log.h"
#include "gpu/tuning/comparison.h"
#include "gpu/tuning/kernel_variant.h"
#include "gpu/tuning/tuning_record.h"

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace ovc {

/// A device's part in tuning. All calls come on the thread of its context.
class VariantTrials {
public:
    virtual ~VariantTrials() = default;
    /// Whether the scene's buffers suit the variant.
    virtual bool can_run(const KernelVariant& variant) = 0;
    /// Begins to compile the variant, and whether that is over.
    virtual void begin(const KernelVariant& variant) = 0;
    virtual bool is_ready(const KernelVariant& variant) = 0;
    /// Traces some of the rays of the pass before, as TimeVariant says.
    virtual std::optional<double> time(const KernelVariant& variant) = 0;
};

struct TuningLimits {
    double seconds = 0.3;      // of measuring, on this device, in all runs together
    double kind_seconds = 0.1; // of them, for one kind of rays; its first candidate may take more
    /// Kernels must have worked so long on a kind before it is measured, so that whoever has few
    /// rays pays nothing.
    double due_seconds = 0.1;
    size_t min_rays = 8192; // of a pass
    ComparisonLimits comparison{};
    double trial_seconds = 0.0015;
    bool in_one_go = false; // waits for the driver's compiler

    /// For somebody who asks for it and waits.
    static TuningLimits thorough();
};

struct PassCost {
    size_t rays = 0;
    double kernel_seconds = 0;
    double seconds = 0; // with everything that the pass waited for, such as a compiler
};

class DeviceTuning {
public:
    /// driver: as for TuningFile.
    DeviceTuning(const DeviceInfo& device, TuningFile file, LogSink log);
    /// Returns one whose file lies in the folder of compiled kernels.
    static std::shared_ptr<DeviceTuning> of(const DeviceInfo& device, LogSink log);

    /// The variants to take now.
    const ChosenVariants& variants() const { return variants_; }

    /// Called after a pass of rays of a kind. May call `trials` many times; at most as long as
    /// `limits` leave.
    void after_pass(RayKind kind, const PassCost& pass, const TuningLimits& limits,
                    VariantTrials& trials);

private:
    struct Candidate {
        KernelVariant variant;
        bool begun = false;
        double seconds = 0; // that it has taken
        std::optional<VariantComparison> result{};
    };
    /// Returns the fastest candidate beyond doubt, or null.
    struct Search {
        double kernel_seconds = 0;
        double compile_seconds = 0; // max of what a pass took besides its kernel
        bool begun = false;
        bool over = false;
        std::vector<Candidate> candidates;
        size_t next = 0;
        double seconds = 0; // that it has taken
    };

    std::optional<VariantComparison> compare_with_default(RayKind kind,
                                                          const KernelVariant& variant,
                                                          const TuningLimits& limits,
                                                          VariantTrials& trials);
    bool is_due(const Search& search, size_t rays, const TuningLimits& limits) const;
    bool is_time(const Search& search, const TuningLimits& limits) const;
    void begin(RayKind kind, Search& search, VariantTrials& trials);
    /// The next thing after a step: another, the next pass of this kind, or the decision.
    enum class Next { Step, Pass, Decide };
    Next go_on(RayKind kind, Search& search, const TuningLimits& limits, VariantTrials& trials);
    void finish(RayKind kind, Search& search, const TuningLimits& limits, VariantTrials& trials);
    static const Candidate* best_of(const Search& search);
    static std::optional<KernelVariant> all_changes_that_gain(const KernelVariant& base,
                                                              const Search& search);
    void tell(RayKind kind, const KernelVariant& variant,
              const std::optional<VariantComparison>& result);

    const DeviceInfo device_;
    const TuningFile file_;
    const LogSink log_;
    const ChosenVariants defaults_;
    TuningRecord record_;
    ChosenVariants variants_;
    std::array<Search, RayKind::kCount> searches_;
    double longest_step_ = 0; // of one candidate
};

} // namespace ovc
