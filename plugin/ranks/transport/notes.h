// SPDX-License-Identifier: Apache-2.0
// Notes: bytes that all ranks exchange at the same point of their program.
#pragma once

#include "plugin/ranks/transport/transport.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace ovc {

class Notes {
public:
    /// Takes the note of a rank; the bytes are valid during the call only.
    using Take = std::function<void(uint32_t rank, std::span<const std::byte> note)>;
    using GoesOn = std::function<bool()>;

    /// The transport's notes come here alone. max_part: bytes of a note in one message, which MPI
    /// limits to 2 GiB; a longer note goes in several.
    explicit Notes(Transport& transport, size_t max_part = size_t(1) << 28)
        : transport_(transport), max_part_(max_part) {}

    /// Sends the bytes of this rank to rank 0, where take() gets those of all ranks, in their
    /// order. All ranks call it. The others return at once. goes_on(): asked some twenty times a
    /// second; where it returns false, rank 0 gives up with an Error of the kind Cancelled. Error:
    /// a rank is lost.
    Result<Done> gather(std::span<const std::byte> mine, const GoesOn& goes_on, const Take& take);
    /// On all ranks, take() gets the bytes that rank 0 passes. All ranks call it.
    Result<Done> spread(std::span<const std::byte> of_first, const GoesOn& goes_on,
                        const Take& take);

private:
    void send(uint32_t to, std::span<const std::byte> note);
    Result<Done> take_from(uint32_t rank, const GoesOn& goes_on, const Take& take);
    Result<Message> next_part(uint32_t rank, const GoesOn& goes_on);

    Transport& transport_;
    const size_t max_part_;
    std::vector<Received> early_; // that nobody has waited for yet
};

/// Returns the first error among those of all ranks, which all call this; its sentence names the
/// rank where that is another. It is `mine` where no rank has one.
Result<Done> first_error(Notes& notes, Transport& transport, const Result<Done>& mine);

} // namespace ovc
