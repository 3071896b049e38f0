// SPDX-License-Identifier: Apache-2.0
// The parameters of a directive that nothing asked for.
#pragma once

#include "importers/pbrt/interpret/diagnostics.h"
#include "importers/pbrt/interpret/parameters.h"

#include <string_view>

namespace ovc::pbrt {

/// Names the parameters that the directive was given and that were not asked for, once per kind:
/// those that pbrt has are approximated, others are missing; those that only say how a picture is
/// computed or stored are passed over. Fails if a parameter that was asked for has more or fewer
/// values than its meaning takes. To be called when the directive is done. type: its class.
void tell_left_over(const Parameters& parameters, std::string_view directive, std::string_view type,
                    Diagnostics& diagnostics);

} // namespace ovc::pbrt
