// SPDX-License-Identifier: Apache-2.0
// A bench's result as tables for people and as JSON for programs (docs/benchmarks.md).
#pragma once

#include "host/bench/bench.h"

#include <span>
#include <string>

namespace ovc {

/// Markdown, with a line end.
std::string bench_table(const BenchResult& result);

/// One document for all scenes, with a line end. What a contender does not have is null.
std::string bench_json(std::span<const BenchResult> results);

} // namespace ovc
