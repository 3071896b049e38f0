// SPDX-License-Identifier: Apache-2.0
#include "gpu/trace/pass_slot.h"

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

} // namespace ovc
