// SPDX-License-Identifier: Apache-2.0
// Exchanges notes by way of rank 0.
#include "plugin/ranks/notes.h"

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

Result<std::vector<std::byte>> Notes::next_from(uint32_t rank,
                                                const std::function<bool()>& goes_on) {
    std::vector<std::byte> note;
    while (true) {
        const auto found = std::ranges::find(early_, rank, &Received::from);
        if (found != early_.end()) {
            const MessageHead head = found->message.head();
            const auto bytes = found->message.items<std::byte>();
            note.insert(note.end(), bytes.begin(), bytes.end());
            early_.erase(found);
            if (head.number + 1 == head.count)
                return note;
            continue;
        }
        if (const std::optional<Error> lost = transport_.lost())
            return *lost;
        if (!goes_on())
            return Error{"cancelled", ErrorKind::Cancelled};
        for (Received& received : transport_.notes.take(std::chrono::milliseconds(50)))
            early_.push_back(std::move(received));
    }
}

Result<std::vector<std::vector<std::byte>>> Notes::gather(std::span<const std::byte> mine,
                                                          const std::function<bool()>& goes_on) {
    send(0, mine);
    std::vector<std::vector<std::byte>> all;
    for (uint32_t rank = 0; transport_.rank() == 0 && rank < transport_.ranks(); ++rank) {
        Result<std::vector<std::byte>> note = next_from(rank, goes_on);
        if (!note)
            return note.error();
        all.push_back(std::move(*note));
    }
    return all;
}

Result<std::vector<std::byte>> Notes::spread(std::span<const std::byte> of_first,
                                             const std::function<bool()>& goes_on) {
    if (transport_.rank() != 0)
        return next_from(0, goes_on);
    for (uint32_t rank = 1; rank < transport_.ranks(); ++rank)
        send(rank, of_first);
    return std::vector<std::byte>(of_first.begin(), of_first.end());
}

static std::span<const std::byte> bytes_of_text(const std::string& text) {
    return std::as_bytes(std::span(text));
}

Result<Done> first_error(Notes& notes, Transport& transport, const Result<Done>& mine) {
    const auto always = [] { return true; };
    const auto all = notes.gather(bytes_of_text(mine ? "" : text_of_error(mine.error())), always);
    if (!all)
        return all.error();
    std::string first;
    for (uint32_t rank = 0; rank < all->size() && first.empty(); ++rank)
        if (const auto& note = (*all)[rank]; !note.empty()) {
            Error error = error_of_text({reinterpret_cast<const char*>(note.data()), note.size()});
            error.message = format_text("{}: {}", transport.name_of(rank), error.message);
            first = text_of_error(error);
        }
    const auto spread = notes.spread(bytes_of_text(first), always);
    if (!spread)
        return spread.error();
    if (!mine || spread->empty())
        return mine;
    const std::string text(reinterpret_cast<const char*>(spread->data()), spread->size());
    return error_of_text(text);
}

} // namespace ovc
