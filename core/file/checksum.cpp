// SPDX-License-Identifier: Apache-2.0
// Checksum: by xxHash; the only file that sees it.
#include "core/file/checksum.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace ovc {

struct Checksum::State {
    XXH3_state_t xxh;
};

void Checksum::Delete::operator()(State* state) const {
    delete state;
}

Checksum::Checksum() : state_(new State) {
    XXH3_64bits_reset(&state_->xxh);
}

void Checksum::add(std::span<const std::byte> bytes) {
    if (!bytes.empty())
        XXH3_64bits_update(&state_->xxh, bytes.data(), bytes.size());
}

uint64_t Checksum::value() const {
    return XXH3_64bits_digest(&state_->xxh);
}

} // namespace ovc
