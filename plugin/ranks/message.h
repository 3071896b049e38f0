// SPDX-License-Identifier: Apache-2.0
// Messages: what ranks send each other. They go as bytes between processes of one program on
// machines of one kind.
#pragma once

#include "core/exclusions.h"
#include "core/ray.h"
#include "core/result.h"

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace ovc {

/// A ray on its way to a rank that has pages for it.
struct RankVisit {
    Ray ray; // t_max: that of the nearest hit so far, or a little more
    TriangleId skip;
    TriangleId after; // with after_t, as in Exclusion::after
    double after_t;
    uint32_t mask;
    uint32_t slot; // the number of the ray in the call at home
};
static_assert(sizeof(RankVisit) == 96);

/// The nearest hit that a visited rank has found.
struct HitThere {
    Hit hit;
    uint32_t slot;
    uint32_t unused = 0;
};

/// Whether a visited rank has found any hit.
struct OcclusionThere {
    uint32_t slot;
    uint32_t occluded;
};

enum class MessageKind : uint32_t {
    NearestVisits, // RankVisit
    AnyVisits,     // RankVisit
    Hits,          // HitThere
    Occlusions,    // OcclusionThere
    Failure,       // a character for the kind of an error, and its sentence
    Note,          // bytes between hosts (host_ranks.h)
};

/// Items of one kind, of one call.
class Message {
public:
    Message() = default;
    /// call: a number that answers carry back, so that those to a call that was given up are told
    /// from those to the next.
    template <class T>
    Message(MessageKind kind, uint32_t call, std::span<const T> items)
        : bytes_(sizeof(Head) + items.size_bytes()) {
        static_assert(std::is_trivially_copyable_v<T>);
        const Head head{kind, call};
        std::memcpy(bytes_.data(), &head, sizeof(head));
        if (!items.empty())
            std::memcpy(bytes_.data() + sizeof(Head), items.data(), items.size_bytes());
    }
    /// Takes what the bytes() of another message were.
    explicit Message(std::vector<std::byte> bytes) : bytes_(std::move(bytes)) {
        assert(bytes_.size() >= sizeof(Head));
    }

    MessageKind kind() const { return head().kind; }
    uint32_t call() const { return head().call; }
    bool has_visits() const {
        return kind() == MessageKind::NearestVisits || kind() == MessageKind::AnyVisits;
    }
    template <class T>
    std::span<const T> items() const {
        const auto bytes = std::span(bytes_).subspan(sizeof(Head));
        return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
    }
    std::span<const std::byte> bytes() const { return bytes_; }

private:
    struct Head {
        MessageKind kind;
        uint32_t call;
    };
    static_assert(sizeof(Head) == 8); // items stay aligned

    Head head() const {
        Head head;
        std::memcpy(&head, bytes_.data(), sizeof(head));
        return head;
    }

    std::vector<std::byte> bytes_;
};

/// Returns the error as text for a message, which is not empty: its kind and its sentence.
inline std::string text_of_error(const Error& error) {
    return char('0' + int(error.kind)) + error.message;
}
inline Error error_of_text(std::string_view text) {
    return {std::string(text.substr(1)), ErrorKind(text.front() - '0')};
}

} // namespace ovc
