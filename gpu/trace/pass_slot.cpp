// SPDX-License-Identifier: Apache-2.0
#include "gpu/trace/pass_slot.h"

#include "core/system/parallel.h"

#include <algorithm>
#include <cassert>

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
    constexpr uint64_t kPartBytes = 4 << 20, kTaskBytes = 256 << 10;
    const std::span<const std::byte> bytes = sent->bytes();
    assert(bytes.size() <= ray_buffer.bytes());
    const uint64_t part_bytes = std::min(kPartBytes, uploads.max_bytes());
    for (uint64_t begin = 0; begin < bytes.size(); begin += part_bytes) {
        const auto part = bytes.subspan(begin, std::min(part_bytes, bytes.size() - begin));
        uploads.write(ray_buffer, begin, part.size(), [&](std::span<std::byte> memory) {
            parallel_for(part.size(), kTaskBytes, [&](size_t from, size_t to) {
                std::copy_n(part.begin() + ptrdiff_t(from), to - from,
                            memory.begin() + ptrdiff_t(from));
            });
        });
    }
}

} // namespace ovc
