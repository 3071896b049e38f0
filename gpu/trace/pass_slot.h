// SPDX-License-Identifier: Apache-2.0
// PassSlot: what one pass has to itself on the device: its rays, its answers and its clock. With
// two slots the next pass can be sent while answers of the one before are read.
#pragma once

#include "gpu/gl/mapped_buffer.h"
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

    /// Makes the buffers for answers of a kernel in place of another kernel's. No pass is under
    /// way.
    void make_answers(Ledger& ledger, bool compute, bool copied_behind);
    /// False where the driver cannot draw to such answers.
    bool is_complete() const { return !pixels || pixels->complete(); }

    const uint32_t max_rays;  // of a pass
    const uint32_t max_slots; // the same with those that packets part
    gl::Buffer ray_buffer;
    /// The rays of the pass that was sent last, where a software renderer reads them in place.
    std::optional<gl::HostBuffer> rays_in_place;
    gl::BufferTexture rays;             // of either
    std::optional<AnswerPixels> pixels; // of the fragment kernel
    std::optional<AnswerWords> words;   // of the compute kernel
    /// Memory of this process that the compute kernel writes candidates' names to, as to the places
    /// of their rays: reading the ray buffer would wait for the pass behind. None: the ray buffer
    /// itself is written, because passes run one by one or the driver gives no such memory.
    std::optional<gl::MappedBuffer> names;
    gl::BufferTexture name_words; // of these, or of the ray buffer
    gl::TimeQuery time;

    // The pass that was sent last:
    SentRays* sent = nullptr; // null: it is over
    RayKind kind;
    KernelVariant variant;
    bool packets = false;     // the kernel takes rays two at a time
    uint32_t stack_words = 0; // of its kernel's stack
    double kernel_seconds = 0;
};

} // namespace ovc
