// SPDX-License-Identifier: Apache-2.0
// Reaches the table of plugin/overcast_ranks.h by dlopen, so that the command needs no MPI.
#include "host/ranks/ranks.h"

#include "host/backend/plugin_loader.h"
#include "host/terminal/interrupt.h"
#include "host/terminal/message.h"
#include "plugin/overcast_ranks.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <thread>

namespace ovc {

static std::unique_ptr<const Ranks>& ranks_of_run() {
    static std::unique_ptr<const Ranks> ranks;
    return ranks;
}

/// Returns how many processes the starter of this one has started; 0: it has none.
static int started_processes() {
    // Set by the starters of Open MPI, and of MPICH and its kin.
    for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
        if (const char* size = std::getenv(name))
            return std::atoi(size);
    return 0;
}

bool Ranks::has_starter() {
    return started_processes() > 0;
}

bool Ranks::are_there() {
    return started_processes() > 1;
}

bool Ranks::library_is_there() {
    std::error_code ignored;
    return std::filesystem::exists(find_plugin(kRankedProduct), ignored);
}

Result<Done> Ranks::open(std::string_view command, double timeout_seconds) {
    if (!are_there() || ranks_of_run())
        return Done{};
    const std::string path = find_plugin(kRankedProduct);
    void* const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (!library)
        return Error{
            fmt::format("several processes need {}, which cannot be loaded: {}; it is built "
                        "where MPI is installed (docs/guide/ranks.md)",
                        kRankedProduct, dlerror())};
    const auto get = reinterpret_cast<ovc_get_ranks_function>(dlsym(library, "ovc_get_ranks"));
    const ovc_ranks* const table = get ? get(timeout_seconds) : nullptr;
    if (!table)
        return Error{fmt::format("MPI cannot be started by '{}'", path)};
    ranks_of_run().reset(new Ranks(*table));
    return ranks_of_run()->agree("command", std::as_bytes(std::span(command)));
}

const Ranks* Ranks::of_run() {
    return ranks_of_run().get();
}

uint32_t Ranks::rank() const {
    return table_.rank;
}

uint32_t Ranks::count() const {
    return table_.ranks;
}

std::string Ranks::name_of(uint32_t rank) const {
    return table_.name_of(rank);
}

namespace {

/// The user pointer of the functions of a call.
struct Waiting {
    const GoesOn& goes_on;
    const Ranks::Take& taker;

    static void take(void* user, uint32_t rank, const void* bytes, size_t size) {
        static_cast<Waiting*>(user)->taker(rank, {static_cast<const std::byte*>(bytes), size});
    }
    static int wait(void* user) { return static_cast<Waiting*>(user)->goes_on() ? 0 : 1; }
};

} // namespace

static Error error_of(const ovc_ranks& table, ovc_result result) {
    return {table.last_error(),
            result == OVC_ERROR_CANCELLED ? ErrorKind::Cancelled : ErrorKind::Other};
}

Result<Done> Ranks::gather(std::span<const std::byte> mine, const GoesOn& goes_on,
                           const Take& take) const {
    Waiting call{goes_on, take};
    if (const ovc_result result =
            table_.gather(mine.data(), mine.size(), Waiting::take, Waiting::wait, &call);
        result != OVC_OK)
        return error_of(table_, result);
    return Done{};
}

Result<std::vector<RankBytes>> Ranks::gather(std::span<const std::byte> mine,
                                             const GoesOn& goes_on) const {
    std::vector<RankBytes> all;
    const Result<Done> done =
        gather(mine, goes_on, [&](uint32_t, std::span<const std::byte> bytes) {
            all.emplace_back(bytes.begin(), bytes.end());
        });
    if (!done)
        return done.error();
    return all;
}

Result<RankBytes> Ranks::spread(std::span<const std::byte> of_first, const GoesOn& goes_on) const {
    RankBytes first;
    const Take take = [&](uint32_t, std::span<const std::byte> bytes) {
        first.assign(bytes.begin(), bytes.end());
    };
    Waiting call{goes_on, take};
    if (const ovc_result result =
            table_.spread(of_first.data(), of_first.size(), Waiting::take, Waiting::wait, &call);
        result != OVC_OK)
        return error_of(table_, result);
    return first;
}

Result<Done> Ranks::agree(std::string_view on, std::span<const std::byte> mine) const {
    const Result<RankBytes> first = spread(mine, goes_on_always);
    if (!first)
        return first.error();
    if (!std::ranges::equal(*first, mine))
        return Error{fmt::format("it has another {} than {}: all ranks need the same command, of "
                                 "the same scene",
                                 on, name_of(0))};
    return Done{};
}

std::vector<uint32_t> Ranks::first_ranks(ovc_scene_t* scene, std::span<const Ray> rays) const {
    std::vector<uint32_t> ranks(rays.size());
    const auto* const abi_rays = reinterpret_cast<const ovc_ray*>(rays.data());
    if (table_.first_ranks(scene, abi_rays, rays.size(), ranks.data()) != OVC_OK)
        ranks.clear();
    return ranks;
}

void Ranks::end_all(int code) const {
    std::fflush(nullptr);
    table_.abort(code);
    std::_Exit(code); // abort() does not return
}

void Ranks::fail_all(std::string_view sentence) const {
    if (!is_first()) // what all of them have to say, the first one says
        std::this_thread::sleep_for(std::chrono::milliseconds(500));
    print_message(fmt::format("{}: {}", name_of(rank()), sentence));
    end_all(kExitError);
}

void Ranks::fail_all_unless(const Result<Done>& done) {
    if (const Ranks* const ranks = of_run(); ranks && !done)
        ranks->fail_all(done.error().message);
}

} // namespace ovc
