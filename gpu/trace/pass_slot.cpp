// SPDX-License-Identifier: Apache-2.0
#include "gpu/trace/pass_slot.h"

namespace ovc {

void PassSlot::make_answers(Ledger& ledger, bool compute, bool copied_behind) {
    if (compute ? words.has_value() : pixels.has_value())
        return;
    words.reset();
    pixels.reset();
    names.reset();
    if (!compute) {
        pixels.emplace(ledger, max_rays, copied_behind);
        return;
    }
    words.emplace(ledger, max_slots, copied_behind);
    if (copied_behind)
        names.emplace(ray_buffer.bytes(), GL_MAP_READ_BIT);
    if (names && names->memory().empty())
        names.reset();
    name_words.show(names ? names->id() : ray_buffer.id(), GL_R32UI, 0, ray_buffer.bytes());
}

} // namespace ovc
