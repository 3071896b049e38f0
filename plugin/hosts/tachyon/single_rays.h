// SPDX-License-Identifier: Apache-2.0
// Triangles in a scene of Overcast's, asked ray by ray from any thread.
#pragma once

#include "plugin/hosts/tachyon/corners.h"
#include "plugin/hosts/tachyon/settings.h"
#include "plugin/overcast.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

namespace ovc::tachyon {

/// Behind this are all hits of a ray.
inline constexpr ovc_hit kBeforeAll{-std::numeric_limits<double>::infinity(), 0, 0, OVC_NONE,
                                    OVC_NONE};

class SingleRays {
public:
    /// Keeps the corners. Throws std::runtime_error with Overcast's sentence.
    SingleRays(Corners corners, const Settings& settings);
    ~SingleRays();
    SingleRays(const SingleRays&) = delete;
    SingleRays& operator=(const SingleRays&) = delete;

    /// The first hit of the ray behind `after`, of no triangle but `skip` (OVC_NONE: of any), or
    /// nothing. From any thread. Throws as the constructor does.
    std::optional<ovc_hit> nearest(const ovc_ray& ray, const ovc_hit& after,
                                   uint32_t skip = OVC_NONE) const;

    ovc_statistics statistics() const;
    std::string renderer() const;

private:
    void check(ovc_result result) const;

    Corners corners_;
    const ovc_api* api_;
    ovc_device device_ = nullptr;
    ovc_scene scene_ = nullptr;
};

} // namespace ovc::tachyon
