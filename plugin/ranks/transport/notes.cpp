// SPDX-License-Identifier: Apache-2.0
// Exchanges notes by way of rank 0.
#include "plugin/ranks/transport/notes.h"

#include "core/text/format_text.h"

#include <algorithm>
#include <chrono>
#include <string>

namespace ovc {

void Notes::send(uint32_t to, std::span<const std::byte> note) {
    const auto parts = uint32_t(std::max<size_t>((note.size() + max_part_ - 1) / max_part_, 1));
    for (uint32_t part = 0; part < parts; ++part) {
        const size_t first = part * max_part_;
        transport_.send(to, Message({.kind = MessageKind::Note, .number = part, .count = parts},
                                    note.subspan(first, std::min(max_part_, note.size() - first))));
    }
}

Result<Message> Notes::next_part(uint32_t rank, const GoesOn& goes_on) {
    while (true) {
        const auto found = std::ranges::find(early_, rank, &Received::from);
        if (found != early_.end()) {
            Message part = std::move(found->message);
            early_.erase(found);
            return part;
        }
        if (const std::optional<Error> lost = transport_.lost())
            return *lost;
        if (!goes_on())
            return Error{"cancelled", ErrorKind::Cancelled};
        for (Received& received : transport_.notes.take(std::chrono::milliseconds(50)))
            early_.push_back(std::move(received));
    }
}

/// Waits for the next note of a rank. A note of one part is not copied.
Result<Done> Notes::take_from(uint32_t rank, const GoesOn& goes_on, const Take& take) {
    std::vector<std::byte> note;
    while (true) {
        const Result<Message> part = next_part(rank, goes_on);
        if (!part)
            return part.error();
        const MessageHead head = part->head();
        const auto bytes = part->items<const std::byte>();
        if (head.count == 1) {
            take(rank, bytes);
            return Done{};
        }
        note.insert(note.end(), bytes.begin(), bytes.end());
        if (head.number + 1 < head.count)
            continue;
        take(rank, note);
        return Done{};
    }
}

Result<Done> Notes::gather(std::span<const std::byte> mine, const GoesOn& goes_on,
                           const Take& take) {
    if (transport_.rank() != 0) {
        send(0, mine);
        return Done{};
    }
    take(0, mine);
    for (uint32_t rank = 1; rank < transport_.ranks(); ++rank)
        if (const Result<Done> done = take_from(rank, goes_on, take); !done)
            return done;
    return Done{};
}

Result<Done> Notes::spread(std::span<const std::byte> of_first, const GoesOn& goes_on,
                           const Take& take) {
    if (transport_.rank() != 0)
        return take_from(0, goes_on, take);
    for (uint32_t rank = 1; rank < transport_.ranks(); ++rank)
        send(rank, of_first);
    take(0, of_first);
    return Done{};
}

static std::span<const std::byte> bytes_of_text(const std::string& text) {
    return std::as_bytes(std::span(text));
}

Result<Done> first_error(Notes& notes, Transport& transport, const Result<Done>& mine) {
    const auto always = [] { return true; };
    std::string first;
    const Result<Done> gathered = notes.gather(
        bytes_of_text(mine ? "" : text_of_error(mine.error())), always,
        [&](uint32_t rank, std::span<const std::byte> note) {
            if (note.empty() || !first.empty())
                return;
            Error error = error_of_text({reinterpret_cast<const char*>(note.data()), note.size()});
            error.message = format_text("{}: {}", transport.name_of(rank), error.message);
            first = text_of_error(error);
        });
    if (!gathered)
        return gathered;
    std::string text;
    const Result<Done> spread =
        notes.spread(bytes_of_text(first), always, [&](uint32_t, std::span<const std::byte> note) {
            text.assign(reinterpret_cast<const char*>(note.data()), note.size());
        });
    if (!spread)
        return spread;
    return !mine || text.empty() ? mine : error_of_text(text);
}

} // namespace ovc
