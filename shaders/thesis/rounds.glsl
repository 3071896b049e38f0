// SPDX-License-Identifier: Apache-2.0
// The walks' loop: a few steps from cell to cell, then one triangle. It ends itself before the driver
// would (OVC_MAX_ROUNDS of config.glsl); the steps count, as the driver counts them.

const int OVC_WALK_STEPS = 8; // a round, at most

bool going_on(bool done, inout int rounds) {
    ++rounds;
    return !done && rounds <= OVC_MAX_ROUNDS / (OVC_WALK_STEPS + 1);
}
