// SPDX-License-Identifier: Apache-2.0
#include "gpu/variants/kernel_variants.h"

#include <optional>
#include <utility>

namespace ovc {
namespace {

constexpr uint32_t kSwitches = 20;

/// Returns the kernel whose switches have the values of these bits, or nothing where no kernel may
/// have them together: packets and refill are the compute kernel's, packets go through no portals,
/// and long stacks are arrays where a driver loses words of those in registers. A stack in shared
/// memory is in no registers, and storage buffers are no images.
std::optional<ShaderConfig> kernel_of(uint32_t bits) {
    const auto take = [&] { return std::exchange(bits, bits >> 1) & 1; };
    ShaderConfig config;
    config.compute = take();
    config.any_hit = take();
    config.certify = take();
    config.portals = take();
    config.may_wait = take();
    config.tell_active = take();
    config.loose_pairs = take();
    config.pool_buffers = take() ? 3 : 1;
    config.stack_depth = take() ? 40 : 8;
    const bool registers = take(), shared = take();
    config.stack = shared      ? StackPlace::Shared
                   : registers ? StackPlace::Registers
                               : StackPlace::Array;
    config.packet = take() ? 2 : 1;
    config.claims = take();
    config.refill = take();
    config.branches = take();
    const bool images = take(), storage = take();
    config.reads = storage  ? TexelReads::StorageBuffers
                   : images ? TexelReads::Images
                            : TexelReads::Textures;
    config.group_size = take() ? 128 : 64;
    config.max_rounds = take() ? kMaxCountedRounds : 0x7fffffff;
    config.float_pairs = take();
    if (!config.compute && (config.packet > 1 || config.claims))
        return std::nullopt;
    if (config.refill && !config.claims)
        return std::nullopt;
    if ((images && storage) || (!config.compute && config.group_size != 64))
        return std::nullopt;
    if (config.portals ? config.packet > 1 : config.float_pairs)
        return std::nullopt;
    if (config.float_pairs && (config.may_wait || !config.certify))
        return std::nullopt;
    if (shared && (registers || !config.compute))
        return std::nullopt;
    if (config.stack != StackPlace::Array && config.stack_depth > 32)
        return std::nullopt;
    return config;
}

/// A number for each two switches with their values.
uint32_t pair_number(uint32_t first, uint32_t second, uint32_t bits) {
    return ((first * kSwitches + second) * 2 + (bits >> first & 1)) * 2 + (bits >> second & 1);
}

uint32_t count_new(const std::vector<bool>& met, uint32_t bits) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < kSwitches; ++i)
        for (uint32_t j = i + 1; j < kSwitches; ++j)
            count += !met[pair_number(i, j, bits)];
    return count;
}

} // namespace

std::vector<ShaderConfig> kernel_variants() {
    std::vector<ShaderConfig> chosen;
    std::vector<bool> met(pair_number(kSwitches, 0, 0));
    for (;;) {
        uint32_t best = 0, best_count = 0;
        // An odd multiplier visits all values in a scattered order, so that ties fall far apart.
        for (uint32_t i = 0; i < 1u << kSwitches; i += 13) {
            const uint32_t bits = i * 40503u & ((1u << kSwitches) - 1);
            if (!kernel_of(bits))
                continue;
            if (const uint32_t count = count_new(met, bits); count > best_count) {
                best = bits;
                best_count = count;
            }
        }
        if (best_count == 0)
            return chosen;
        chosen.push_back(*kernel_of(best));
        for (uint32_t i = 0; i < kSwitches; ++i)
            for (uint32_t j = i + 1; j < kSwitches; ++j)
                met[pair_number(i, j, best)] = true;
    }
}

} // namespace ovc
