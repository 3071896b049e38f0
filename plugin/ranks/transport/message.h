// SPDX-License-Identifier: Apache-2.0
// Messages: what ranks send each other. They go as bytes between processes of one program on
// machines of one kind.
#pragma once

#include "core/exclusions.h"
#include "core/ray.h"
#include "core/result.h"
#include "plugin/ranks/transport/message_bytes.h"

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace ovc {

enum class MessageKind : uint32_t {
    NearestVisits, // VisitArrays
    AnyVisits,     // VisitArrays
    Hits,          // the nearest Hit of each visit, in their order
    Occlusions,    // a byte for each visit, in their order: 1 where it has any hit
    Failure,       // a character for the kind of an error, and its sentence
    Note,          // bytes between hosts (notes.h)
};

/// Stands before the items of a message.
struct MessageHead {
    MessageKind kind = MessageKind::Note;
    uint32_t call = 0;   // answers carry these two back, so that those to a call that was given up
    uint32_t number = 0; // are told from those to the next
    uint32_t count = 0;  // of items
    uint32_t arrays = 0; // of VisitArrays, which there are
    uint32_t unused = 0; // items stay aligned
};
static_assert(sizeof(MessageHead) == 24);

/// A head and items of one kind. Only moved, never copied.
class Message {
public:
    Message() = default;
    /// Makes a message whose items, so many bytes, are not set yet.
    Message(const MessageHead& head, size_t item_bytes)
        : Message(MessageBytes(sizeof(head) + item_bytes)) {
        std::memcpy(bytes_.data(), &head, sizeof(head));
    }
    template <class T>
    Message(const MessageHead& head, std::span<const T> items) : Message(head, items.size_bytes()) {
        static_assert(std::is_trivially_copyable_v<T>);
        if (!items.empty())
            std::memcpy(item_bytes(), items.data(), items.size_bytes());
    }
    /// Takes what the bytes() of another message were.
    explicit Message(MessageBytes bytes) : bytes_(std::move(bytes)) {
        assert(bytes_.size() >= sizeof(MessageHead));
    }

    MessageHead head() const {
        MessageHead head;
        std::memcpy(&head, bytes_.data(), sizeof(head));
        return head;
    }
    MessageKind kind() const { return head().kind; }
    bool has_visits() const {
        return kind() == MessageKind::NearestVisits || kind() == MessageKind::AnyVisits;
    }
    std::byte* item_bytes() const { return bytes_.data() + sizeof(MessageHead); }
    template <class T>
    std::span<T> items() const {
        return {reinterpret_cast<T*>(item_bytes()),
                (bytes_.size() - sizeof(MessageHead)) / sizeof(T)};
    }
    std::span<const std::byte> bytes() const { return {bytes_.data(), bytes_.size()}; }

private:
    MessageBytes bytes_;
};

/// Returns the error as text for a message, which is not empty: its kind and its sentence.
inline std::string text_of_error(const Error& error) {
    return char('0' + int(error.kind)) + error.message;
}
inline Error error_of_text(std::string_view text) {
    return {std::string(text.substr(1)), ErrorKind(text.front() - '0')};
}

} // namespace ovc
