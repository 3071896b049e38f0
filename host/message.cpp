// SPDX-License-Identifier: Apache-2.0
#include "host/message.h"

#include "core/printable.h"

#include <fmt/format.h>

#include <cstdio>

namespace ovc {

void print_message(std::string_view sentence) {
    fmt::print(stderr, "overcast: {}\n", printable(sentence));
}

} // namespace ovc
