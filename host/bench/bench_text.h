// SPDX-License-Identifier: Apache-2.0
// Writes a bench's result as tables for people and as JSON for programs (docs/benchmarks.md).
#pragma once

#include "host/bench/bench.h"

#include <span>
#include <string>

namespace ovc {

/// Returns Markdown that ends with a line end.
std::string bench_table(const BenchResult& result);

/// Returns one document for all scenes, with a line end. Values that a contender does not have are
/// null.
std::string bench_json(std::span<const BenchResult> results);

} // namespace ovc
