// SPDX-License-Identifier: Apache-2.0
// SCENE on the command line: a file, or the name of a generated test scene.
#pragma once

#include "core/log.h"
#include "core/result.h"
#include "core/scene.h"

#include <string>

namespace ovc {

/// The name of a test scene makes that scene; everything else is a file (./plants is a file even if
/// plants is not).
Result<Scene> open_scene(const std::string& source, const LogSink& log);

/// Writes warnings and errors, and Info if `chatty`, to standard error, one line each.
LogSink standard_error_log(bool chatty);

} // namespace ovc
