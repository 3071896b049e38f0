// SPDX-License-Identifier: Apache-2.0
// DataFile: what #fopen opens: values one after the other, read or written. Nothing is written to
// disk; what a scene writes it can read again.
#pragma once

#include "importers/pov/values/value.h"

namespace ovc::pov {

struct DataFile {
    std::string name;
    std::string text;
    bool writes = false;

    /// The next text, float or vector; nothing where something else stands there. Behind it, spaces
    /// and a comma are passed over.
    std::optional<Value> read();
    bool ended() const { return at_ >= text.size(); }
    /// A text as it is, a float or vector as it is read again. Nothing else: false.
    bool write(const Value& value);
    void skip_space();

private:
    std::optional<double> read_float();

    size_t at_ = 0;
};

} // namespace ovc::pov
