// SPDX-License-Identifier: Apache-2.0
// Checks to make before the first call into OpenGL or EGL. Where they fail, libepoxy or the driver
// would end the process.
#pragma once

#include "core/result.h"

#include <filesystem>
#include <optional>

namespace ovc {

/// Opens libEGL and libOpenGL, or libGL, for good. libepoxy opens them at its first call, and
/// aborts if it cannot. Error: the library that is missing, and the package that has it; of the
/// kind OutOfMemory if there is no memory to load it.
Result<Done> open_gl_libraries();

/// Gives the index of Mesa's shader cache its blocks on disk. Mesa maps that sparse file and writes
/// to it; if the disk is full then, the system kills the process (SIGBUS). folder: the cache's; it
/// need not exist. Error: the disk is full, and how to free it.
Result<Done> reserve_shader_cache_index(const std::filesystem::path& folder);

/// The folder that Mesa would use in this environment; nothing if its cache is off.
std::optional<std::filesystem::path> mesa_shader_cache();

} // namespace ovc
