// SPDX-License-Identifier: Apache-2.0
// This file takes the place of backend_embree.cpp where Embree is not installed.
#include "host/backend/backend.h"

namespace ovc {

Result<std::unique_ptr<Backend>> make_embree_backend(const Soup&, EmbreeMode, const LogSink&) {
    return Error{"this program was built without Embree (libembree-dev, -DOVC_EMBREE=ON)"};
}

} // namespace ovc
