// SPDX-License-Identifier: Apache-2.0
// Blocks that are passed over.
#pragma once

#include "importers/pov/words/reader.h"

namespace ovc::pov {

/// Passes over everything up to the } that ends the block this stands in; that } is taken.
void skip_block(Reader& reader);
/// `{ … }`, from the { on.
void skip_braces(Reader& reader, std::string_view after);

} // namespace ovc::pov
