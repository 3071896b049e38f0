// SPDX-License-Identifier: Apache-2.0
// Exchanges notes by way of rank 0.
#include "plugin/ranks/notes.h"

#include "core/text/format_text.h"

#include <algorithm>
#include <chrono>
#include <string>

namespace ovc {

static Parcel note_of(std::span<const std::byte> bytes) {
    return {ParcelKind::Note, 0, bytes};
}

Result<std::vector<std::byte>> Notes::next_from(uint32_t rank,
                                                const std::function<bool()>& goes_on) {
    while (true) {
        const auto found = std::ranges::find(early_, rank, &Inbox::Letter::from);
        if (found != early_.end()) {
            const auto bytes = found->parcel.items<std::byte>();
            std::vector<std::byte> note(bytes.begin(), bytes.end());
            early_.erase(found);
            return note;
        }
        if (const std::optional<Error> lost = post_.lost())
            return *lost;
        if (!goes_on())
            return Error{"cancelled", ErrorKind::Cancelled};
        for (Inbox::Letter& letter : post_.notes.take(std::chrono::milliseconds(50)))
            early_.push_back(std::move(letter));
    }
}

Result<std::vector<std::vector<std::byte>>> Notes::gather(std::span<const std::byte> mine,
                                                          const std::function<bool()>& goes_on) {
    post_.send(0, note_of(mine));
    std::vector<std::vector<std::byte>> all;
    for (uint32_t rank = 0; post_.rank() == 0 && rank < post_.ranks(); ++rank) {
        Result<std::vector<std::byte>> note = next_from(rank, goes_on);
        if (!note)
            return note.error();
        all.push_back(std::move(*note));
    }
    return all;
}

Result<std::vector<std::byte>> Notes::spread(std::span<const std::byte> of_first,
                                             const std::function<bool()>& goes_on) {
    if (post_.rank() != 0)
        return next_from(0, goes_on);
    for (uint32_t rank = 1; rank < post_.ranks(); ++rank)
        post_.send(rank, note_of(of_first));
    return std::vector<std::byte>(of_first.begin(), of_first.end());
}

static std::span<const std::byte> bytes_of_text(const std::string& text) {
    return std::as_bytes(std::span(text));
}

Result<Done> first_error(Notes& notes, Post& post, const Result<Done>& mine) {
    const auto always = [] { return true; };
    const auto all = notes.gather(bytes_of_text(mine ? "" : text_of_error(mine.error())), always);
    if (!all)
        return all.error();
    std::string first;
    for (uint32_t rank = 0; rank < all->size() && first.empty(); ++rank)
        if (const auto& note = (*all)[rank]; !note.empty()) {
            Error error = error_of_text({reinterpret_cast<const char*>(note.data()), note.size()});
            error.message = format_text("{}: {}", post.name_of(rank), error.message);
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
