// SPDX-License-Identifier: Apache-2.0
// The table of overcast_ranks.h.
#include "plugin/overcast_ranks.h"

#include "core/system/caught_error.h"
#include "plugin/abi/ray_call.h"
#include "plugin/abi/scene_call.h"
#include "plugin/ranks/transport/mpi_transport.h"
#include "plugin/ranks/transport/notes.h"

#include <cstdlib>
#include <memory>
#include <string>

namespace ovc {
namespace {

struct HostRanks {
    std::unique_ptr<Transport> transport;
    std::unique_ptr<Notes> notes;
    std::vector<std::string> names;
    std::string error;
    ovc_ranks table{};
};

HostRanks& host_ranks() {
    static HostRanks* const all = new HostRanks; // closed at exit, but never gone
    return *all;
}

std::function<bool()> waits(ovc_wait_function wait, void* user) {
    return [=] { return !wait || wait(user) == 0; };
}

std::span<const std::byte> span_of(const void* bytes, size_t size) {
    return {static_cast<const std::byte*>(bytes), size};
}

ovc_result failed(Error error) noexcept {
    host_ranks().error = std::move(error.message);
    return error.kind == ErrorKind::Cancelled ? OVC_ERROR_CANCELLED : OVC_ERROR_INTERNAL;
}

/// Runs body(), which returns a Result; nothing that it throws leaves the library.
template <class Body>
ovc_result guarded(const void* bytes, size_t size, ovc_take_function take, Body&& body) {
    try {
        if (!take || (!bytes && size > 0)) {
            host_ranks().error = "ovc_ranks: take is NULL, or bytes is and size is not 0";
            return OVC_ERROR_INVALID_ARGUMENT;
        }
        const Result<Done> done = body();
        return done ? OVC_OK : failed(done.error());
    } catch (...) {
        return failed(caught_error());
    }
}

Notes::Take takes(ovc_take_function take, void* user) {
    return [=](uint32_t rank, std::span<const std::byte> note) {
        take(user, rank, note.data(), note.size());
    };
}

ovc_result gather(const void* bytes, size_t size, ovc_take_function take, ovc_wait_function wait,
                  void* user) {
    return guarded(bytes, size, take, [&] {
        return host_ranks().notes->gather(span_of(bytes, size), waits(wait, user),
                                          takes(take, user));
    });
}

ovc_result spread(const void* bytes, size_t size, ovc_take_function take, ovc_wait_function wait,
                  void* user) {
    return guarded(bytes, size, take, [&] {
        return host_ranks().notes->spread(span_of(bytes, size), waits(wait, user),
                                          takes(take, user));
    });
}

ovc_result first_ranks(ovc_scene scene, const ovc_ray* rays, size_t ray_count, uint32_t* ranks) {
    return on_scene(scene, "first_ranks", [&] {
        check_buffers("first_ranks", rays, ranks, ray_count);
        const std::span<const Ray> all(reinterpret_cast<const Ray*>(rays), ray_count);
        committed(scene, "first_ranks").first_ranks(all, {ranks, ray_count});
    });
}

bool open(double timeout_seconds) {
    HostRanks& all = host_ranks();
    Result<std::unique_ptr<Transport>> transport =
        make_mpi_transport({.timeout_seconds = timeout_seconds, .may_end_process = true});
    if (!transport)
        return false;
    all.transport = std::move(*transport);
    all.notes = std::make_unique<Notes>(*all.transport);
    for (uint32_t rank = 0; rank < all.transport->ranks(); ++rank)
        all.names.push_back(all.transport->name_of(rank));
    std::atexit([] { host_ranks().transport.reset(); }); // before MPI is ended
    all.table = {sizeof(ovc_ranks),
                 all.transport->rank(),
                 all.transport->ranks(),
                 [](uint32_t rank) { return host_ranks().names.at(rank).c_str(); },
                 [] { return host_ranks().error.c_str(); },
                 gather,
                 spread,
                 [](int code) { abort_all_ranks(code); },
                 no_throw<first_ranks>};
    return true;
}

} // namespace
} // namespace ovc

extern "C" const ovc_ranks* ovc_get_ranks(double timeout_seconds) {
    try {
        ovc_ranks& table = ovc::host_ranks().table;
        return table.struct_size || ovc::open(timeout_seconds) ? &table : nullptr;
    } catch (...) { // there is no memory
        return nullptr;
    }
}
