// SPDX-License-Identifier: Apache-2.0
// Calls the C ABI, rightly and wrongly, in an order that bytes determine.
#pragma once

#include <cstddef>
#include <cstdint>

namespace ovc {

/// Calls functions of the table in the order and with the arguments that `data` says, on a few
/// scenes of one device, which lasts as long as the process. Aborts where an answer is not that of
/// a plain loop over all triangles, or an error has no sentence. Returns false where there is no
/// device.
bool fuzz_calls(const uint8_t* data, size_t size);

} // namespace ovc
