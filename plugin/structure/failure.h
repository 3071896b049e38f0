// SPDX-License-Identifier: Apache-2.0
// Failure: the exception that carries an error to the C ABI. It is thrown and caught inside the
// plugin only.
#pragma once

#include "plugin/overcast.h"

#include <string>

namespace ovc {

struct Failure {
    ovc_result code;
    std::string message;
};

} // namespace ovc
