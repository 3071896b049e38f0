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

/// A variable's value; null: not set.
using Environment = std::function<const char*(const char* name)>;

/// The variables to set for 512 bits, and their values: none where the user has chosen a width, the
/// CPU has no AVX-512, or fragment kernels are asked for, with which llvmpipe (22.3) crashes there.
/// Mesa keeps what it compiled under a key that lacks the width: so it gets a folder of its own.
std::map<std::string, std::string> wide_vectors(const Environment& environment, bool has_avx512,
                                                bool fragment_kernels);

/// Sets them for this process, before it opens its first device: later ones are as the first.
void use_wide_vectors(bool fragment_kernels);

/// The same for a process that has only this backend.
void use_wide_vectors(const BackendOptions& options);

} // namespace ovc
