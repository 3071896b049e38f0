// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/words/block.h"

namespace ovc::pov {

void skip_block(Reader& reader) {
    const Place start = reader.place();
    for (int depth = 1; depth > 0;) {
        const Token token = reader.next();
        if (token.kind == TokenKind::End)
            reader.fail(start, "found no '}' to this block");
        depth += token.is('{') ? 1 : token.is('}') ? -1 : 0;
    }
}

void skip_braces(Reader& reader, std::string_view after) {
    reader.expect('{', after);
    skip_block(reader);
}

} // namespace ovc::pov
