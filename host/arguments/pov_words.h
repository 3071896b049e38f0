// SPDX-License-Identifier: Apache-2.0
// POV-Ray's command line in ours: +W640 +H480 +Iscene.pov +Opicture.png.
#pragma once

#include "core/result.h"
#include "core/system/log.h"

#include <string>
#include <vector>

namespace ovc {

/// The words that begin with a plus, and POV-Ray's own that begin with a minus and a capital
/// letter, in ours; all others as they are, but that --camera and --light are joined with their
/// value, which may begin with a minus sign. log: is told which words mean nothing here. Error: a
/// word that cannot be understood or obeyed, with the option to take instead.
Result<std::vector<std::string>> translate_pov_words(const std::vector<std::string>& arguments,
                                                     const LogSink& log);

} // namespace ovc
