// SPDX-License-Identifier: Apache-2.0
// ByteWriter and ByteReader turn values into bytes and back: numbers as they lie in memory, strings
// and vectors behind their length. Reading believes nothing.
#pragma once

#include "core/file/archive.h"

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

namespace ovc {

template <class T>
inline constexpr bool kIsOptional = false;
template <class T>
inline constexpr bool kIsOptional<std::optional<T>> = true;
template <class T>
inline constexpr bool kIsVector = false;
template <class T>
inline constexpr bool kIsVector<std::vector<T>> = true;

class ByteWriter {
public:
    template <class... T>
    void operator()(const T&... values) {
        (put(values), ...);
    }
    Bytes bytes() const { return bytes_; }

private:
    void put_raw(const void* data, size_t size) {
        const auto* from = static_cast<const std::byte*>(data);
        bytes_.insert(bytes_.end(), from, from + size);
    }

    template <class T>
    void put(const T& value) {
        if constexpr (std::same_as<T, bool>) {
            put(uint8_t(value));
        } else if constexpr (std::same_as<T, std::string>) {
            put(uint64_t(value.size()));
            put_raw(value.data(), value.size());
        } else if constexpr (kIsOptional<T>) {
            put(value.has_value());
            if (value)
                put(*value);
        } else if constexpr (kIsVector<T>) {
            put(uint64_t(value.size()));
            for (const auto& item : value)
                put(item);
        } else if constexpr (requires { each_field(*this, value); }) {
            each_field(*this, value);
        } else {
            static_assert(std::is_trivially_copyable_v<T>);
            put_raw(&value, sizeof(T));
        }
    }

    std::vector<std::byte> bytes_;
};

class ByteReader {
public:
    explicit ByteReader(Bytes bytes) : rest_(bytes) {}

    template <class... T>
    void operator()(T&... values) {
        (take(values), ...);
    }
    /// Returns whether the bytes sufficed so far and every flag was 0 or 1.
    bool ok() const { return ok_; }
    /// Returns whether ok() and no byte is left.
    bool done() const { return ok_ && rest_.empty(); }

private:
    bool take_raw(void* to, size_t size) {
        ok_ = ok_ && size <= rest_.size();
        if (!ok_)
            return false;
        if (size > 0)
            std::memcpy(to, rest_.data(), size);
        rest_ = rest_.subspan(size);
        return true;
    }

    template <class T>
    static T blank() {
        if constexpr (std::default_initializable<T>)
            return T();
        else
            return std::bit_cast<T>(std::array<std::byte, sizeof(T)>{});
    }

    template <class T>
    void take(T& value) {
        if constexpr (std::same_as<T, bool>) {
            uint8_t byte = 0;
            take(byte);
            ok_ = ok_ && byte <= 1;
            value = byte == 1;
        } else if constexpr (std::same_as<T, std::string>) {
            uint64_t size = 0;
            take(size);
            ok_ = ok_ && size <= rest_.size();
            if (ok_) {
                value.resize(size_t(size));
                take_raw(value.data(), value.size());
            }
        } else if constexpr (kIsOptional<T>) {
            bool has = false;
            take(has);
            value.reset();
            if (ok_ && has)
                take(value.emplace());
        } else if constexpr (kIsVector<T>) {
            uint64_t size = 0;
            take(size);
            // Grown item by item, because the size may claim more than there is.
            for (value.clear(); ok_ && size > 0; --size)
                take(value.emplace_back(blank<typename T::value_type>()));
        } else if constexpr (requires { each_field(*this, value); }) {
            each_field(*this, value);
        } else {
            static_assert(std::is_trivially_copyable_v<T>);
            take_raw(&value, sizeof(T));
        }
    }

    Bytes rest_;
    bool ok_ = true;
};

} // namespace ovc
