// SPDX-License-Identifier: Apache-2.0
// The experiments of the report, a file each.
#pragma once

#include "host/report/experiments/experiment.h"

namespace ovc {

/// What each choice of precision, kernel, leaves, budget and program costs, and how wrong it is.
Experiment error_experiment();
/// Finer triangles against exact round shapes.
Experiment tessellation_experiment();
/// Errors of pictures by samples a pixel.
Experiment samples_experiment();
/// The stability suite, and a grid of scales, offsets and aspects.
Experiment hard_experiment();
/// Rays, triangles, leaves and budgets from few to many.
Experiment scale_experiment();
/// What renderings have no need of.
Experiment left_out_experiment();
/// What README.md, docs/guide/performance.md and docs/benchmarks.md claim.
Experiment claims_experiment();
/// Chapter 4 of the thesis, a scene each.
Experiment pictures_experiment();
Experiment dragons_experiment();
Experiment dragonball_experiment();
Experiment plants_experiment();
Experiment powerplant_experiment();

} // namespace ovc
