// SPDX-License-Identifier: Apache-2.0
// Translates POV-Ray's command line into ours: +W640 +H480 +Iscene.pov +Opicture.png.
#pragma once

#include "core/result.h"
#include "core/system/log.h"

#include <string>
#include <vector>

namespace ovc {

/// Returns the arguments with POV-Ray's translated into ours: words that begin with a plus, or with
/// a minus and a capital letter, settings such as Width=640, and .ini files. All others stay, but
/// --camera and --light are joined with their value, which may begin with a minus sign. log: is
/// told which words mean nothing here. Error: a word that cannot be understood or obeyed, with the
/// option to take instead.
Result<std::vector<std::string>> translate_pov_words(const std::vector<std::string>& arguments,
                                                     const LogSink& log);

} // namespace ovc
