// SPDX-License-Identifier: Apache-2.0
// Measures the cost of reading a file: seconds, and peak memory.
#pragma once

#include "core/result.h"

#include <cstdint>
#include <string>

namespace ovc {

struct ImportCost {
    uint64_t file_bytes = 0;
    uint64_t soup_bytes = 0; // corners and normals, as they are kept
    uint64_t peak_bytes = 0; // peak resident memory above that before reading
    double cpu_seconds = 0;  // median, all threads together

    double peak_to_soup() const { return double(peak_bytes) / double(soup_bytes); }
    double megabytes_per_second() const { return 1e-6 * double(file_bytes) / cpu_seconds; }
};

/// Reads the file `times` times, at least once (asserted), in a child process, so that nothing else
/// is counted. The calling process must have run no parallel loop yet, because its threads would be
/// missing in the child. Error: the reader's sentence.
Result<ImportCost> measure_import(const std::string& path, uint32_t times);

} // namespace ovc
