// SPDX-License-Identifier: Apache-2.0
#include "gpu/trace/pass_slot.h"

#include <algorithm>
#include <cassert>
#include <cstring>

namespace ovc {

void PassSlot::make_answers(Ledger& ledger, bool compute, bool copied_behind) {
    if (compute ? words.has_value() : pixels.has_value())
        return;
    words.reset();
    pixels.reset();
    if (compute)
        words.emplace(ledger, max_slots, copied_behind);
    else
        pixels.emplace(ledger, max_rays, copied_behind);
}

void PassSlot::upload(const Uploads& uploads) const {
    constexpr uint64_t kPartBytes = 4 << 20;
    const std::span<const std::byte> bytes = sent->bytes();
    assert(bytes.size() <= ray_buffer.bytes());
    const uint64_t part_bytes = std::min(kPartBytes, uploads.max_bytes());
    for (uint64_t begin = 0; begin < bytes.size(); begin += part_bytes) {
        const auto part = bytes.subspan(begin, std::min(part_bytes, bytes.size() - begin));
        uploads.write(ray_buffer, begin, part.size(), [&](std::span<std::byte> memory) {
            // Not by tasks: this thread could come to do others' tasks before it starts the pass.
            std::memcpy(memory.data(), part.data(), part.size());
        });
    }
}

} // namespace ovc
