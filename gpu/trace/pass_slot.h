// SPDX-License-Identifier: Apache-2.0
// PassSlot: what one pass has to itself on the device: its rays, its answers and its clock. With
// two slots the next pass can be sent while answers of the one before are read.
#pragma once

#include "gpu/trace/answers.h"
#include "gpu/trace/sent_rays.h"
#include "gpu/tuning/kernel_variant.h"

#include <cstdint>
#include <optional>

namespace ovc {

struct PassSlot {
    PassSlot(Ledger& ledger, uint32_t batch_rays, uint32_t parted_rays)
        : max_rays(batch_rays),
          max_slots(batch_rays + parted_rays),
          ray_buffer(ledger, uint64_t(batch_rays) * sizeof(RayState), "rays") {}

    /// Makes the buffer for answers of a kernel in place of another kernel's. No pass is under way.
    void make_answers(Ledger& ledger, bool compute, bool copied_behind);
    /// False where the driver cannot draw to such answers.
    bool is_complete() const { return !pixels || pixels->complete(); }

    const uint32_t max_rays;  // of a pass
    const uint32_t max_slots; // the same with those that packets part
    gl::Buffer ray_buffer;
    gl::BufferTexture rays;
    gl::BufferTexture ray_words;        // the same, for the kernel to write names
    std::optional<AnswerPixels> pixels; // of the fragment kernel
    std::optional<AnswerWords> words;   // of the compute kernel
    gl::TimeQuery time;

    // Of the pass that was sent last:
    SentRays* sent = nullptr; // null: it is over
    RayKind kind;
    KernelVariant variant;
    bool packets = false; // the kernel takes rays two at a time
    double kernel_seconds = 0;
};

} // namespace ovc
