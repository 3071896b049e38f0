// SPDX-License-Identifier: Apache-2.0
// The four texels of a unit (layout.h).

struct Unit {
    uvec4 x;
    uvec4 y;
    uvec4 z;
    uvec4 w;
};

// Counts what is fetched for the ray, where anybody asks.
#if OVC_COUNTS
int units_fetched = 0;
Unit counted(Unit unit) {
    ++units_fetched;
    return unit;
}
#else
#define counted(unit) unit
#endif

bool is_pair(Unit unit) { return int(unit.w.w) < 0; }
