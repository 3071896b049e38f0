// SPDX-License-Identifier: Apache-2.0
#include "gpu/tuning/kernel_variant.h"

#include "core/text/format_text.h"
#include "shaders/layout.h"

#include <algorithm>
#include <charconv>

namespace ovc {
namespace {

// Words of a stack. Each word in registers is one (two with several buffers) and costs 1 % of the
// time on llvmpipe; of a million rays at the Stanford dragon thirty need more words
// (docs/decisions/0012).
constexpr uint32_t kRegisterWords = 8, kSharedWords = 12;
constexpr std::array<std::string_view, 3> kReads{"textures", "images", "storage"};

/// Takes "group=64" apart. Returns whether the word is `name` with a number.
bool take_number(std::string_view word, std::string_view name, uint32_t& number) {
    if (!word.starts_with(name) || word.size() <= name.size() || word[name.size()] != '=')
        return false;
    const char* const first = word.data() + name.size() + 1;
    const char* const last = word.data() + word.size();
    const auto [end, error] = std::from_chars(first, last, number);
    return error == std::errc() && end == last && first != last;
}

bool take_stack(std::string_view word, KernelVariant& variant) {
    if (take_number(word, "registers", variant.stack_words))
        variant.stack = StackPlace::Registers;
    else if (take_number(word, "shared", variant.stack_words))
        variant.stack = StackPlace::Shared;
    else
        return false;
    return variant.stack_words > 0 && variant.stack_words <= 64;
}

bool take_word(std::string_view word, KernelVariant& variant) {
    const auto reads = std::ranges::find(kReads, word);
    if (reads != kReads.end())
        variant.reads = TexelReads(reads - kReads.begin());
    else if (word == "compute" || word == "fragment")
        variant.compute = word == "compute";
    else if (word == "packets")
        variant.packets = true;
    else if (word == "refill")
        variant.refill = true;
    else if (word == "branches" || word == "both-sides")
        variant.branches = word == "branches";
    else if (word == "array")
        variant.stack = StackPlace::Array, variant.stack_words = 0;
    else if (word == "float-pairs")
        variant.float_pairs = true;
    else if (!take_number(word, "group", variant.group_size))
        return take_stack(word, variant);
    return true;
}

bool is_sound(const KernelVariant& v) {
    const bool size = v.group_size == 32 || v.group_size == 64 || v.group_size == 128;
    return size && (v.compute || !(v.packets || v.refill || v.stack == StackPlace::Shared));
}

} // namespace

std::string KernelVariant::text() const {
    std::string text = compute ? format_text("compute,group={}", group_size) : "fragment";
    text += packets ? ",packets" : "";
    text += refill ? ",refill" : "";
    text += branches ? ",branches" : ",both-sides";
    if (stack == StackPlace::Array)
        text += ",array";
    else
        text += format_text(",{}={}", stack == StackPlace::Shared ? "shared" : "registers",
                            stack_words);
    text += float_pairs ? ",float-pairs" : "";
    return text + "," + std::string(kReads[size_t(reads)]);
}

Result<KernelVariant> parse_variant(std::string_view text) {
    KernelVariant variant;
    for (std::string_view rest = text;;) {
        const size_t comma = std::min(rest.find(','), rest.size());
        if (!take_word(rest.substr(0, comma), variant))
            return Error{
                format_text("'{}' is no switch of a kernel, in '{}'; there are compute, "
                            "fragment, group=N, packets, refill, branches, "
                            "both-sides, registers=N, shared=N, array, float-pairs, textures, "
                            "images, storage",
                            rest.substr(0, comma), text)};
        if (comma == rest.size())
            break;
        rest.remove_prefix(comma + 1);
    }
    if (!is_sound(variant))
        return Error{format_text("no kernel is '{}': group is 32, 64 or 128, and packets, "
                                 "refill and shared are the compute kernel's",
                                 text)};
    return variant;
}

ChosenVariants default_variants(const DeviceInfo& device, bool compute) {
    KernelVariant variant{.compute = compute};
    variant.stack = compute && !device.is_software ? StackPlace::Shared : StackPlace::Registers;
    variant.stack_words = variant.stack == StackPlace::Shared ? kSharedWords : kRegisterWords;
    if (!device.is_software)
        return ChosenVariants(variant);
    if (compute) // then threads share a pass of few rays
        variant.group_size = 32;
    variant.packets = compute;
    variant.refill = compute && device.can_refill();
    variant.branches = false;
    variant.reads = TexelReads::Images;
    ChosenVariants variants(variant);
    // Lanes that go alike end together, and taking up a ray means to go through the first portal,
    // to which rays among few frames have far to go, unless any hit ends them.
    using enum RayKind::Frames;
    variants[{.frames = Few, .coherent = true}].refill = false;
    return variants;
}

std::vector<KernelVariant> neighbours(const KernelVariant& from, const DeviceInfo& device,
                                      bool other_kernel) {
    std::vector<KernelVariant> found;
    const auto add = [&](auto change) {
        KernelVariant variant = from;
        change(variant);
        if (!(variant == from) && is_sound(variant) && (!variant.refill || device.can_refill()))
            found.push_back(variant);
    };
    const auto add_stack = [&](StackPlace place, uint32_t words) {
        add([&](KernelVariant& v) { v.stack = place, v.stack_words = words; });
    };
    if (from.stack != StackPlace::Shared)
        add_stack(StackPlace::Shared, kSharedWords);
    if (from.stack != StackPlace::Registers)
        add_stack(StackPlace::Registers, kRegisterWords);
    add([](KernelVariant& v) { v.float_pairs = !v.float_pairs; });
    for (const TexelReads reads :
         {TexelReads::StorageBuffers, TexelReads::Images, TexelReads::Textures})
        add([&](KernelVariant& v) { v.reads = reads; });
    for (const uint32_t size : {32, 128, 64})
        if (from.compute)
            add([&](KernelVariant& v) { v.group_size = size; });
    add([](KernelVariant& v) { v.branches = !v.branches; });
    add([](KernelVariant& v) { v.packets = !v.packets; });
    add([](KernelVariant& v) { v.refill = !v.refill; });
    if (from.stack != StackPlace::Array)
        add_stack(StackPlace::Array, 0);
    if (other_kernel)
        add([](KernelVariant& v) {
            v.compute = !v.compute;
            v.packets = v.refill = false;
            v.group_size = KernelVariant{}.group_size; // the fragment kernel has no groups
            if (v.stack == StackPlace::Shared)
                v.stack = StackPlace::Registers, v.stack_words = kRegisterWords;
        });
    return found;
}

KernelVariant with_changes(KernelVariant base, const KernelVariant& from,
                           const KernelVariant& changed) {
    const auto take = [&](auto member) {
        if (changed.*member != from.*member)
            base.*member = changed.*member;
    };
    take(&KernelVariant::compute);
    take(&KernelVariant::group_size);
    take(&KernelVariant::packets);
    take(&KernelVariant::refill);
    take(&KernelVariant::branches);
    take(&KernelVariant::stack);
    take(&KernelVariant::stack_words);
    take(&KernelVariant::float_pairs);
    take(&KernelVariant::reads);
    return base;
}

bool can_read(const DeviceInfo& device, const KernelVariant& variant, uint32_t buffers,
              uint64_t buffer_bytes) {
    const bool small =
        variant.reads != TexelReads::StorageBuffers || buffer_bytes <= device.max_storage_bytes;
    return small && buffers <= device.pool_buffers_by_reads[size_t(variant.reads)];
}

std::string RayKind::text() const {
    static constexpr const char* kFrames[] = {"one frame", "few frames", "many frames"};
    return format_text("{}, {} rays, {}", any_hit ? "any hit" : "nearest hit",
                       coherent ? "coherent" : "scattered", kFrames[size_t(frames)]);
}

} // namespace ovc
