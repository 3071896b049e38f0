// SPDX-License-Identifier: Apache-2.0
// Ranks: the processes that mpirun has started to do one command's work together.
#pragma once

#include "core/ray.h"
#include "core/result.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

struct ovc_ranks;
struct ovc_scene_t;

namespace ovc {

/// The library that has the ABI of the product for scenes of several ranks, and the ranks.
inline constexpr const char* kRankedProduct = "libovercast-mpi.so";

using RankBytes = std::vector<std::byte>;

/// Asked some twenty times a second while something is waited for; false: no longer.
using GoesOn = std::function<bool()>;
/// The GoesOn of calls that only an answer or a lost rank ends.
inline bool goes_on_always() {
    return true;
}

class Ranks {
public:
    /// Whether mpirun, or what does its work, has started this process; perhaps it alone.
    static bool has_starter();
    /// Returns whether this is so, and there are several.
    static bool are_there();
    /// Whether the library was built and lies where open() looks for it.
    static bool library_is_there();
    /// Loads the library and starts MPI, where are_there(). All processes call it, with the same
    /// command. timeout_seconds: a rank that gives no word for so long is lost; 0: 60.
    static Result<Done> open(std::string_view command, double timeout_seconds);
    /// Returns the ranks after open(); null for a process that is alone.
    static const Ranks* of_run();

    uint32_t rank() const;
    uint32_t count() const;
    bool is_first() const { return rank() == 0; }
    std::string name_of(uint32_t rank) const;

    /// Brings the bytes of all ranks, which all call this, to rank 0, in their order; the others
    /// return at once, with nothing. Error of the kind Cancelled: it was not waited for. Error: a
    /// rank is lost.
    Result<std::vector<RankBytes>> gather(std::span<const std::byte> mine,
                                          const GoesOn& goes_on) const;
    /// The same, where take() gets the bytes of each rank, valid during the call only: those of all
    /// ranks are then not there at once.
    using Take = std::function<void(uint32_t rank, std::span<const std::byte>)>;
    Result<Done> gather(std::span<const std::byte> mine, const GoesOn& goes_on,
                        const Take& take) const;
    /// Brings the bytes of rank 0 to all ranks, which all call this. Errors as of gather().
    Result<RankBytes> spread(std::span<const std::byte> of_first, const GoesOn& goes_on) const;
    /// Compares bytes that stand for the ranks' command, picture or the like with those of rank 0;
    /// all ranks call it. Error: they are others, or a rank is lost.
    Result<Done> agree(std::string_view on, std::span<const std::byte> mine) const;
    /// Returns for each ray the rank whose leaves of the scene it comes by first, of those that no
    /// other rank has; kNone where there is none, and nothing where that cannot be told.
    std::vector<uint32_t> first_ranks(ovc_scene_t* scene, std::span<const Ray> rays) const;
    /// Ends all processes at once, with this exit code.
    [[noreturn]] void end_all(int code) const;
    /// Says what has failed here, and ends all processes, which would wait for this one.
    [[noreturn]] void fail_all(std::string_view sentence) const;
    /// Does so where this process is one of several and `done` an error: to be called before a
    /// scene is destroyed, which waits for the other ranks.
    static void fail_all_unless(const Result<Done>& done);

private:
    explicit Ranks(const ovc_ranks& table) : table_(table) {}

    const ovc_ranks& table_;
};

} // namespace ovc
