// SPDX-License-Identifier: Apache-2.0
// How wide the vectors are that Mesa's software renderer compiles kernels for. It takes 256 bits
// unless the environment says otherwise; on a CPU with AVX-512 the compute kernel is faster at 512
// (docs/benchmarks.md). The plugin leaves the environment alone, a host may set its own.
#pragma once

#include "host/backend/backend.h"

#include <functional>
#include <map>
#include <string>

namespace ovc {

/// Returns the value of a variable; null where it is not set.
using Environment = std::function<const char*(const char* name)>;

/// Returns the variables to set for 512 bits, with their values. There are none where the user has
/// chosen a width, the CPU has no AVX-512, or fragment kernels are asked for: llvmpipe (22.3)
/// crashes on those at 512 bits. Mesa caches compiled kernels under a key that lacks the width, so
/// one variable gives this width a cache folder of its own, or none where no place is known.
std::map<std::string, std::string> wide_vectors(const Environment& environment, bool has_avx512,
                                                bool fragment_kernels);

/// Sets these variables for this process. Call it before the process opens its first device,
/// because later devices take the width of the first.
void use_wide_vectors(bool fragment_kernels);

/// Sets them for a process whose only backend has these options.
void use_wide_vectors(const BackendOptions& options);

} // namespace ovc
