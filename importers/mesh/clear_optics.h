// SPDX-License-Identifier: Apache-2.0
// The optics of a surface that also lets light through, for those that send out light.
#pragma once

#include "core/scene.h"

namespace ovc {

/// Returns the material's color, transmission, filter and ior as optics, without its mirror.
inline Optics clear_optics(const Material& material) {
    const float share = material.transmission;
    Optics optics;
    optics.diffuse = (1 - share) * material.color;
    if (share > 0 && material.ior != 1)
        optics.boundary = Optics::Boundary::Dielectric;
    optics.ior = material.ior;
    optics.through = share * material.filter;
    return optics;
}

} // namespace ovc
