// SPDX-License-Identifier: Apache-2.0
// The defects of drivers that Overcast works around, in one table. It lists neither limits that a
// driver reports nor features that are merely slow on one.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace ovc {

enum class Workaround {
    PassedOver,
    CountedRounds,
    ShortRegisterStack,
    FinishedPass,
    NarrowFragments,
    RendererInSources,
    ReservedCacheIndex,
    ConfusedTexels,
};

struct WorkaroundEntry {
    Workaround which;
    std::string_view name;    // for OVERCAST_NO_WORKAROUNDS
    std::string_view driver;  // part of GL_RENDERER, in any case; empty: every driver
    std::string_view version; // part of GL_VERSION; empty: every version
    std::string_view symptom;
    std::string_view answer; // what Overcast does about it
    std::string_view test;   // the test of that answer
};

inline constexpr std::array<WorkaroundEntry, 8> kWorkarounds{{
    {Workaround::PassedOver, "passed-over", "zink", "Mesa 22.3",
     "crashes when kernels are compiled (seen over lavapipe)",
     "the driver is passed over; another one is chosen by unsetting MESA_LOADER_DRIVER_OVERRIDE",
     "EglContextGl.DriversThatEndTheProcessArePassedOver"},
    {Workaround::CountedRounds, "counted-rounds", "llvmpipe", "",
     "ends the loops of an invocation after 65,535 rounds without a word",
     "kernels count rounds, and a ray that reaches 65,000 is decided in doubles",
     "TwoLevelGl.ALoopThatTheDriverEndsIsCountedAndDecidedInDouble"},
    {Workaround::ShortRegisterStack, "short-register-stack", "llvmpipe", "",
     "loses words of a stack in registers that is longer than the 32 rounds that Mesa unrolls",
     "longer stacks are arrays", "Instances.SharePagesAndAnswerAlike"},
    {Workaround::FinishedPass, "finished-pass", "llvmpipe", "",
     "writes to buffers that a pass under way still reads as images",
     "a pass is over before anything else is sent", "ManyBuffersGl.AnswerAsOneDoesWherePagesMove"},
    {Workaround::NarrowFragments, "narrow-fragments", "llvmpipe", "",
     "crashes when it compiles any fragment shader for vectors of 512 bits",
     "fragment kernels are refused there", "VectorWidth.IsNotForFragmentKernels"},
    {Workaround::RendererInSources, "renderer-in-sources", "", "",
     "Mesa's cache of programs overlooks llvmpipe's vector width, so a program for eight lanes is "
     "taken for one of sixteen, and every other ray has no answer",
     "the renderer's name is a comment in every source", "Invariance.SoupOverVectorWidths"},
    {Workaround::ReservedCacheIndex, "reserved-cache-index", "", "",
     "Mesa maps the index of its shader cache, and dies of SIGBUS where the disk is full",
     "the index is reserved first, and a full disk is an error",
     "ShaderCache.AFullDiskIsToldBeforeTheDriverCrashesOnIt"},
    {Workaround::ConfusedTexels, "confused-texels", "softpipe", "",
     "takes one texel of a buffer texture for another where it has more than 16,384",
     "kernels read images or storage buffers, and a variant that reads textures is refused",
     "KernelVariant.ReadsNoMoreThanTheDriverLetsIt"},
}};

/// The entry of a workaround.
constexpr const WorkaroundEntry& entry_of(Workaround which) {
    return kWorkarounds[size_t(which)];
}

/// Whether the driver has the defect, as far as the table knows. renderer, version: GL's strings.
bool has_defect(Workaround which, std::string_view renderer, std::string_view version);

/// The same for the driver of the current context, unless the environment variable
/// OVERCAST_NO_WORKAROUNDS has the workaround's name in its list, separated by commas. Use it to
/// see whether a later driver still needs the workaround.
bool needs(Workaround which);

/// Whether OVERCAST_NO_WORKAROUNDS names it.
bool is_switched_off(Workaround which);

} // namespace ovc
