// SPDX-License-Identifier: Apache-2.0
// What the command says on standard error: the only place that writes sentences there.
#pragma once

#include <string_view>

namespace ovc {

/// "overcast: sentence" in a line of its own, printable whatever names are in it.
void print_message(std::string_view sentence);

} // namespace ovc
