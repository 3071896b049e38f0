// SPDX-License-Identifier: Apache-2.0
// The loop of both walks: a few steps from cell to cell, then one triangle. It ends itself before
// the driver would (OVC_MAX_ROUNDS of config.glsl); steps count as rounds, as they do for the
// driver.

const int OVC_WALK_STEPS = 8; // the max in a round

bool going_on(bool done, inout int rounds) {
    ++rounds;
    return !done && rounds <= OVC_MAX_ROUNDS / (OVC_WALK_STEPS + 1);
}
