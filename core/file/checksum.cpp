// SPDX-License-Identifier: Apache-2.0
// XXH64, step by step as its description has them. It is our own, so that the library builds with
// only three others; checksum_test.cpp compares it with xxHash's.
#include "core/file/checksum.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>

namespace ovc {
namespace {

static_assert(std::endian::native == std::endian::little);

template <class Word>
uint64_t read(const std::byte* bytes) {
    Word word;
    std::memcpy(&word, bytes, sizeof(word));
    return word;
}

} // namespace

uint64_t Checksum::round(uint64_t lane, uint64_t word) {
    return std::rotl(lane + word * kPrimes[1], 31) * kPrimes[0];
}

/// Adds whole stripes from the front of `bytes`, and returns what is left.
std::span<const std::byte> Checksum::add_stripes(std::span<const std::byte> bytes) {
    std::array<uint64_t, 4> lanes = lanes_; // a copy that stays in registers
    for (; bytes.size() >= kStripe; bytes = bytes.subspan(kStripe))
        for (size_t i = 0; i < lanes.size(); ++i)
            lanes[i] = round(lanes[i], read<uint64_t>(bytes.data() + 8 * i));
    lanes_ = lanes;
    return bytes;
}

void Checksum::add(std::span<const std::byte> bytes) {
    if (const size_t begun = bytes_ % kStripe; begun > 0) {
        const size_t more = std::min(kStripe - begun, bytes.size());
        std::copy_n(bytes.begin(), more, rest_.begin() + ptrdiff_t(begun));
        bytes_ += more;
        bytes = bytes.subspan(more);
        if (begun + more < kStripe)
            return;
        add_stripes(rest_);
    }
    bytes_ += bytes.size();
    bytes = add_stripes(bytes);
    assert(bytes.size() < kStripe);
    std::copy(bytes.begin(), bytes.end(), rest_.begin());
}

uint64_t Checksum::value() const {
    uint64_t sum = kPrimes[4];
    if (bytes_ >= kStripe) {
        sum = std::rotl(lanes_[0], 1) + std::rotl(lanes_[1], 7) + std::rotl(lanes_[2], 12) +
              std::rotl(lanes_[3], 18);
        for (const uint64_t lane : lanes_)
            sum = (sum ^ round(0, lane)) * kPrimes[0] + kPrimes[3];
    }
    sum += bytes_;
    const std::byte* at = rest_.data();
    const std::byte* const end = at + bytes_ % kStripe;
    for (; end - at >= 8; at += 8)
        sum = std::rotl(sum ^ round(0, read<uint64_t>(at)), 27) * kPrimes[0] + kPrimes[3];
    if (end - at >= 4) {
        sum = std::rotl(sum ^ read<uint32_t>(at) * kPrimes[0], 23) * kPrimes[1] + kPrimes[2];
        at += 4;
    }
    for (; at < end; ++at)
        sum = std::rotl(sum ^ read<uint8_t>(at) * kPrimes[4], 11) * kPrimes[0];
    sum = (sum ^ sum >> 33) * kPrimes[1];
    sum = (sum ^ sum >> 29) * kPrimes[2];
    return sum ^ sum >> 32;
}

} // namespace ovc
