// SPDX-License-Identifier: Apache-2.0
// AskedProgress: asks ovc_query.progress whether a call goes on, fifty times a second at most.
#pragma once

#include "plugin/abi/float_mode.h"
#include "plugin/abi/host_function.h"
#include "plugin/overcast.h"
#include "plugin/structure/structure.h"

#include <chrono>

namespace ovc {

class AskedProgress final : public TraceWatch {
public:
    /// mode: that of the call; it outlives this.
    AskedProgress(const ovc_query& query, HostFloatMode& mode)
        : progress_(query.progress), user_(query.progress_user), mode_(mode) {}

    bool goes_on(double done) override {
        if (!progress_ || Clock::now() < next_)
            return true;
        next_ = Clock::now() + std::chrono::milliseconds(20);
        const HostFunction mark;
        return mode_.call([&] { return progress_(user_, done, "rays") == 0; });
    }

private:
    using Clock = std::chrono::steady_clock;

    const ovc_progress_function progress_;
    void* const user_;
    HostFloatMode& mode_;
    Clock::time_point next_{};
};

} // namespace ovc
