// SPDX-License-Identifier: Apache-2.0
// Skips blocks that Overcast does not read.
#pragma once

#include "importers/pov/words/reader.h"

namespace ovc::pov {

/// Skips everything up to the end of the current block and takes its }.
void skip_block(Reader& reader);
/// Skips `{ … }` from its { on. `after` names the word in front of it for messages.
void skip_braces(Reader& reader, std::string_view after);

} // namespace ovc::pov
