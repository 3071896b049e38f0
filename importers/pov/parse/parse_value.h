// SPDX-License-Identifier: Apache-2.0
// Whatever may stand to the right of #declare's =, and as an argument of a macro.
#pragma once

#include "importers/pov/values/expression.h"

namespace ovc::pov {

Value parse_value(Reader& reader);

} // namespace ovc::pov
