// SPDX-License-Identifier: Apache-2.0
// A failure on its way to the ABI; thrown and caught inside the plugin only.
#pragma once

#include "plugin/overcast.h"

#include <string>

namespace ovc {

struct Failure {
    ovc_result code;
    std::string message;
};

} // namespace ovc
