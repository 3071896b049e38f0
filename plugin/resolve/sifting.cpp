// SPDX-License-Identifier: Apache-2.0
#include "plugin/resolve/sifting.h"

#include <algorithm>
#include <cassert>

namespace ovc {
namespace {

/// Asks the filter about the hits of these indices.
void ask(HitFilter& filter, const Sieves& sieves, std::span<const uint32_t> indices,
         std::span<const uint32_t> rays, std::span<const Hit> hits, std::vector<uint8_t>& counts) {
    std::vector<uint64_t> names;
    std::vector<Hit> asked;
    for (const uint32_t j : indices) {
        names.push_back(sieves[rays[j]].name);
        asked.push_back(hits[j]);
    }
    std::vector<uint8_t> keep(indices.size(), 1);
    if (!filter.keep(names, asked, keep))
        return; // the call ends, and its answers do not matter
    for (size_t k = 0; k < indices.size(); ++k)
        counts[indices[k]] = keep[k] != 0;
}

} // namespace

std::vector<uint8_t> counting_hits(const Soup& soup, const Sieves& sieves,
                                   std::span<const uint32_t> rays, std::span<const Hit> hits) {
    assert(rays.size() == hits.size());
    std::vector<uint8_t> counts(hits.size());
    std::vector<uint32_t> asked;
    for (uint32_t j = 0; j < hits.size(); ++j) {
        const RaySieve sieve = sieves[rays[j]];
        counts[j] = sees(sieve.mask, soup.chunks[hits[j].id.mesh].mask());
        if (counts[j] && sieve.filter)
            asked.push_back(j);
    }
    for (auto first = asked.begin(); first != asked.end();) {
        HitFilter* const filter = sieves[rays[*first]].filter;
        const auto end = std::stable_partition(
            first, asked.end(), [&](uint32_t j) { return sieves[rays[j]].filter == filter; });
        ask(*filter, sieves, {first, end}, rays, hits, counts);
        first = end;
    }
    return counts;
}

bool counts(const Soup& soup, const RaySieve& sieve, const Hit& hit) {
    const uint32_t ray = 0;
    Sieves one{{&sieve.mask, 1}, {}, {&sieve.name, 1}};
    if (sieve.filter)
        one.filters = {&sieve.filter, 1};
    return counting_hits(soup, one, {&ray, 1}, {&hit, 1}).front() != 0;
}

} // namespace ovc
