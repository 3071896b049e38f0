// SPDX-License-Identifier: Apache-2.0
// AskedFilter: asks ovc_query.filter which hits count.
#pragma once

#include "core/sieve.h"
#include "plugin/abi/host_function.h"
#include "plugin/overcast.h"

#include <atomic>
#include <cassert>

namespace ovc {

class AskedFilter final : public HitFilter {
public:
    AskedFilter(ovc_filter_function filter, void* user) : filter_(filter), user_(user) {}

    bool keep(std::span<const uint64_t> rays, std::span<const Hit> hits,
              std::span<uint8_t> keep) override {
        assert(rays.size() == hits.size() && keep.size() == hits.size());
        if (stopped_)
            return false;
        const HostFunction mark;
        const auto* const given = reinterpret_cast<const ovc_hit*>(hits.data());
        if (filter_(user_, hits.size(), rays.data(), given, keep.data()) != 0)
            stopped_ = true;
        return !stopped_;
    }

    bool is_there() const { return filter_ != nullptr; }
    /// Whether the host has stopped the call.
    bool stopped() const { return stopped_; }
    bool is_of(ovc_filter_function filter, const void* user) const {
        return filter_ == filter && user_ == user;
    }

private:
    const ovc_filter_function filter_;
    void* const user_;
    std::atomic<bool> stopped_{false};
};

} // namespace ovc
