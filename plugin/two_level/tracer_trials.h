// SPDX-License-Identifier: Apache-2.0
// TracerTrials: traces some rays of a pass again and again, each time as another variant of the
// kernel, and compares their answers.
#pragma once

#include "core/system/log.h"
#include "core/text/format_text.h"
#include "gpu/trace/tracer.h"
#include "gpu/tuning/device_tuning.h"

#include <optional>
#include <span>
#include <vector>

namespace ovc {

class TracerTrials final : public VariantTrials {
public:
    /// rays: some of the pass that the tracer has collected last. The tracer outlives this.
    TracerTrials(Tracer& tracer, SentRays rays, LogSink log)
        : tracer_(tracer), rays_(std::move(rays)), log_(std::move(log)) {}

    bool can_run(const KernelVariant& variant) override { return tracer_.can_run(variant); }
    void begin(const KernelVariant& variant) override { tracer_.begin_to_compile(variant); }
    bool is_ready(const KernelVariant& variant) override { return tracer_.is_ready(variant); }

    std::optional<double> time(const KernelVariant& variant) override {
        tracer_.use(ChosenVariants(variant));
        if (!tracer_.trace(rays_, answers_))
            return {};
        if (expected_.names.empty())
            expected_ = answers_;
        const size_t different = count_contradictions();
        if (different == 0 && count_in_doubt(answers_) > count_in_doubt(expected_) + few())
            return {}; // the host would have to decide too many of its rays
        if (different == 0)
            return tracer_.kernel_seconds();
        say(log_, LogLevel::Warning,
            format_text("kernel variant {} contradicts another in {} of {} answers, and is not "
                        "used; please tell us, with the output of `overcast devices`",
                        variant.text(), different, rays_.size()));
        return {};
    }

private:
    /// Counts the rays for which both kernels are certain, of different triangles.
    size_t count_contradictions() const {
        const bool any_hit = tracer_.ray_kind().any_hit;
        const auto is_certain = [](const Answer& a) {
            return a.prim != OVC_FLAGGED && a.prim != OVC_CAPPED &&
                   a.further()[0] == OVC_NO_TRIANGLE;
        };
        size_t count = 0;
        for (size_t i = 0; i < rays_.size(); ++i) {
            const Answer a = answers_[i], b = expected_[i];
            const bool alike =
                any_hit ? (a.prim == OVC_MISS) == (b.prim == OVC_MISS) : a.prim == b.prim;
            count += !alike && is_certain(a) && is_certain(b);
        }
        return count;
    }

    size_t count_in_doubt(const Answers& answers) const {
        size_t count = 0;
        for (size_t i = 0; i < rays_.size(); ++i)
            count += answers[i].prim == OVC_FLAGGED || answers[i].prim == OVC_CAPPED;
        return count;
    }
    /// So many more rays in doubt make no difference.
    size_t few() const { return rays_.size() / 1024; }

    Tracer& tracer_;
    SentRays rays_;
    const LogSink log_;
    Answers answers_;
    Answers expected_; // of the variant that was timed first
};

} // namespace ovc
