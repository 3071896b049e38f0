// SPDX-License-Identifier: Apache-2.0
// The experiments of the report, each in a file of its own.
#pragma once

#include "host/report/experiments/experiment.h"

namespace ovc {

/// Measures what each choice of precision, kernel, leaves, budget and program costs, and how wrong
/// it is.
Experiment error_experiment();
/// Compares finer and finer triangles with exact round shapes.
Experiment tessellation_experiment();
/// Measures errors of pictures by samples a pixel.
Experiment samples_experiment();
/// Runs the stability suite, and a grid of scales, offsets and aspects.
Experiment hard_experiment();
/// Measures cost as rays, triangles, leaves and budgets grow.
Experiment scale_experiment();
/// Measures the savings by leaving out what a rendering does not need.
Experiment left_out_experiment();
/// Checks the claims of README.md, docs/guide/performance.md and docs/benchmarks.md.
Experiment claims_experiment();
/// These repeat chapter 4 of the thesis, a scene each.
Experiment pictures_experiment();
Experiment dragons_experiment();
Experiment dragonball_experiment();
Experiment plants_experiment();
Experiment powerplant_experiment();

} // namespace ovc
