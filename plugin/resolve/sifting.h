// SPDX-License-Identifier: Apache-2.0
// Sifting: tells which hits count by the sieves of their rays.
#pragma once

#include "core/sieve.h"
#include "core/soup.h"

#include <vector>

namespace ovc {

/// Returns 1 for each of the hits, one of each of the rays, that counts, and 0 for the others. The
/// masks are asked first, and the filters only about what these let pass.
std::vector<uint8_t> counting_hits(const Soup& soup, const Sieves& sieves,
                                   std::span<const uint32_t> rays, std::span<const Hit> hits);

/// Returns whether a hit of a ray with this sieve counts.
bool counts(const Soup& soup, const RaySieve& sieve, const Hit& hit);

} // namespace ovc
