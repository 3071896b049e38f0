// SPDX-License-Identifier: Apache-2.0
// Checksum: 64 bits that tell damaged or other bytes from the ones there were. Not against an
// adversary.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>

namespace ovc {

/// XXH3-64 of all bytes added, in whatever parts they came: some 10 GB/s. Move-only.
class Checksum {
public:
    Checksum();

    void add(std::span<const std::byte> bytes);
    template <class T>
    void add_value(const T& value) {
        static_assert(std::has_unique_object_representations_v<T> || std::is_floating_point_v<T>);
        add(std::as_bytes(std::span(&value, 1)));
    }

    /// Of what was added so far.
    uint64_t value() const;

private:
    struct State;
    struct Delete {
        void operator()(State* state) const;
    };
    std::unique_ptr<State, Delete> state_;
};

inline uint64_t checksum_of(std::span<const std::byte> bytes) {
    Checksum sum;
    sum.add(bytes);
    return sum.value();
}

} // namespace ovc
