// SPDX-License-Identifier: Apache-2.0
// The four texels of a unit (layout.h).

struct Unit {
    uvec4 x;
    uvec4 y;
    uvec4 z;
    uvec4 w;
};

bool is_pair(Unit unit) { return int(unit.w.w) < 0; }
