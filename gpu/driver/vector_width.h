// SPDX-License-Identifier: Apache-2.0
// How wide the vectors are that Mesa's software renderer compiles kernels for. It takes 256 bits
// unless the environment says otherwise; on a CPU with AVX-512 the compute kernel is faster at 512
// (docs/benchmarks.md).
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>

namespace ovc {

/// Returns the value of a variable; null where it is not set.
using GetVariable = std::function<const char*(const char* name)>;

/// Returns the variables to set for 512 bits, with their values. There are none where the user has
/// chosen a width, the CPU has no AVX-512, or fragment kernels are asked for: llvmpipe (22.3)
/// crashes on those at 512 bits. Mesa caches compiled kernels under a key that lacks the width, so
/// one variable gives this width a cache folder of its own, or none where no place is known.
std::map<std::string, std::string> wide_vectors(const GetVariable& variable, bool has_avx512,
                                                bool fragment_kernels);

/// Sets these variables for this process. Call it before the process opens its first device,
/// because later devices take the width of the first.
void use_wide_vectors(bool fragment_kernels);

/// Returns what to tell a host whose software renderer, by this name, has vectors narrower than the
/// CPU's, though the environment names no width; nothing where there is nothing to tell.
/// fragment_kernels: the host has said that it needs fragment shaders.
std::optional<std::string> advice_on_vectors(const std::string& renderer,
                                             const GetVariable& variable, bool has_avx512,
                                             bool fragment_kernels);
/// The same for this process and its CPU, and what use_wide_vectors() was told.
std::optional<std::string> advice_on_vectors(const std::string& renderer);

} // namespace ovc
