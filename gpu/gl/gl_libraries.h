// SPDX-License-Identifier: Apache-2.0
// What must be there before the first call into OpenGL or EGL, because what is behind these calls
// would end the process otherwise.
#pragma once

#include "core/result.h"

#include <filesystem>
#include <optional>

namespace ovc {

/// libepoxy opens libEGL and libOpenGL, or libGL, at its first call, and aborts where it cannot.
/// This opens them before, for good. Error: what is missing, and the package that has it; of the
/// kind OutOfMemory where there is no room for it.
Result<Done> open_gl_libraries();

/// Mesa maps the index of its shader cache, a sparse file, and writes to it: where the disk is full
/// then, the process is killed (SIGBUS). This gives the file its blocks before. folder: the
/// cache's; it need not exist. Error: no room, and what to do about it.
Result<Done> reserve_shader_cache_index(const std::filesystem::path& folder);

/// The folder that Mesa would use in this environment; nothing where its cache is off.
std::optional<std::filesystem::path> mesa_shader_cache();

} // namespace ovc
