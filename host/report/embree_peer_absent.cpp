// SPDX-License-Identifier: Apache-2.0
// In place of embree_peer.cpp where Embree is not installed.
#include "host/report/embree_peer.h"

namespace ovc {

std::unique_ptr<EmbreePeer> make_embree_peer(const Soup&) {
    return nullptr;
}

} // namespace ovc
