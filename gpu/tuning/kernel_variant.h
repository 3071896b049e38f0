// SPDX-License-Identifier: Apache-2.0
// KernelVariant: how a kernel goes about its work. Every choice that is about speed alone is here,
// as a value that can be measured (docs/decisions/0032), printed and read back.
#pragma once

#include "core/result.h"
#include "gpu/gl/egl_context.h"
#include "gpu/gl/kernel.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ovc {

/// Certified answers are the same bits whichever variant a kernel is. Those that a device cannot
/// run, and switches that mean nothing together, are left out by neighbours().
struct KernelVariant {
    bool compute = true;      // false: the fragment kernel, which lacks some of the others
    bool float_pairs = false; // frames are changed in pairs of floats; else in doubles
    uint32_t group_size = 64; // invocations
    bool packets = false;     // rays that go alike are taken two at a time
    bool refill = false;      // a lane takes the next ray when its own is done
    bool branches = true;     // a step runs only the code for its kind of unit
    StackPlace stack = StackPlace::Array;
    uint32_t stack_words = 0; // of a stack that is not an array
    TexelReads reads = TexelReads::Textures;

    bool operator==(const KernelVariant&) const = default;
    /// Returns the switches by name: "compute,group=64,branches,shared=12,textures".
    std::string text() const;
};

/// Returns the variant of a text. Error: a word that is no switch, or switches that mean nothing
/// together.
Result<KernelVariant> parse_variant(std::string_view text);

/// Returns the variants that differ from `from` in one switch and that the device can run, the most
/// promising first. kernels: whether the other kernel is one of them.
std::vector<KernelVariant> neighbours(const KernelVariant& from, const DeviceInfo& device,
                                      bool other_kernel);

/// Returns `base` with every switch in which `changed` differs from `from`.
KernelVariant with_changes(KernelVariant base, const KernelVariant& from,
                           const KernelVariant& changed);

/// Whether a kernel can read so many buffers, of at most so many bytes each, in the variant's way.
bool can_read(const DeviceInfo& device, const KernelVariant& variant, uint32_t buffers,
              uint64_t buffer_bytes);

/// The rays of a pass have this in common, as far as kernels care. Each kind has a variant.
struct RayKind {
    /// What they go through (shaders/portals.glsl): one frame, the frames of pages that reach far,
    /// or those of instances.
    enum class Frames { One, Few, Many };
    static constexpr size_t kFewFrames = 256;
    static Frames frames_of(size_t portals) {
        return portals == 0 ? Frames::One : portals <= kFewFrames ? Frames::Few : Frames::Many;
    }

    bool any_hit = false;
    Frames frames = Frames::One;
    bool coherent = false; // neighbours go alike (gpu/trace/packets.h)

    static constexpr size_t kCount = 12;
    size_t number() const {
        return (size_t(frames) << 1 | size_t(any_hit)) << 1 | size_t(coherent);
    }
    static RayKind of(size_t number) {
        return {(number & 2) != 0, Frames(number >> 2), (number & 1) != 0};
    }
    bool has_portals() const { return frames != Frames::One; }
    /// Returns "nearest hits, scattered rays, one frame" and the like.
    std::string text() const;
};

/// A variant for each kind of rays.
class ChosenVariants {
public:
    ChosenVariants() = default;
    explicit ChosenVariants(const KernelVariant& all) { variants_.fill(all); }
    const KernelVariant& operator[](RayKind kind) const { return variants_[kind.number()]; }
    KernelVariant& operator[](RayKind kind) { return variants_[kind.number()]; }

private:
    std::array<KernelVariant, RayKind::kCount> variants_{};
};

/// Returns the variants that are taken where nothing was measured: for llvmpipe what was measured
/// there (docs/decisions/0011 and later), for all others what GPUs are made for.
ChosenVariants default_variants(const DeviceInfo& device, bool compute = true);

} // namespace ovc
