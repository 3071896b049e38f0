// SPDX-License-Identifier: Apache-2.0
// The census sums triangles along the order in which objects were completed.
#include "importers/pbrt/census.h"

#include "importers/file/available_memory.h"
#include "importers/readers.h"

#include <fmt/format.h>

#include <cassert>
#include <limits>

namespace ovc::pbrt {

namespace {

constexpr uint64_t kSaturated = std::numeric_limits<uint64_t>::max();

/// The memory of a triangle's corners; and of an instance's chunk, mesh and transform.
constexpr uint64_t kTriangleBytes = 36, kInstanceBytes = 512;

/// The memory that reading and building take for a triangle (plugin/out_of_core/host_budget.h).
constexpr uint64_t kBytesToConvert = 500;

uint64_t plus(uint64_t a, uint64_t b) {
    return a > kSaturated - b ? kSaturated : a + b;
}

uint64_t times(uint64_t a, uint64_t b) {
    return b != 0 && a > kSaturated / b ? kSaturated : a * b;
}

uint64_t own_triangles(const Object& object) {
    uint64_t count = object.streamed;
    for (const Shape& shape : object.shapes)
        count += shape.mesh.size();
    return count;
}

uint64_t expanded(const Object& object, const std::vector<uint64_t>& within) {
    uint64_t count = own_triangles(object);
    for (const Instance& instance : object.instances) {
        assert(instance.object < within.size());
        count = plus(count, within[instance.object]);
    }
    return count;
}

void place(const Object& object, uint64_t copies, std::vector<uint64_t>& placed) {
    for (const Instance& instance : object.instances)
        placed[instance.object] = plus(placed[instance.object], copies);
}

std::string shown(uint64_t count) {
    return count == kSaturated ? "more than 18446744073709551614" : fmt::format("{}", count);
}

} // namespace

Census take_census(const World& world) {
    Census census;
    for (const Object& object : world.objects)
        census.within.push_back(expanded(object, census.within));
    census.triangles = expanded(world.top, census.within);
    census.unique = own_triangles(world.top);

    // An object comes before all objects that contain it, so from the last to the first every count
    // is final when it is used.
    std::vector<uint64_t> placed(world.objects.size(), 0);
    place(world.top, 1, placed);
    census.kept = own_triangles(world.top);
    census.shared.resize(world.objects.size());
    for (size_t i = world.objects.size(); i-- > 0;) {
        const uint64_t own = own_triangles(world.objects[i]);
        census.shared[i] = placed[i] > 1 && own >= kMinShared;
        census.kept = plus(census.kept, census.shared[i] ? own : times(own, placed[i]));
        census.unique += own;
        if (placed[i] == 0)
            continue;
        place(world.objects[i], placed[i], placed);
        census.instances = plus(census.instances, placed[i]);
    }
    return census;
}

Result<Done> check_census(const Census& census, uint64_t max_triangles, bool is_held) {
    const std::string what =
        fmt::format("{} triangles once {} instances of {} are expanded", shown(census.triangles),
                    shown(census.instances), shown(census.unique));
    if (census.kept > max_triangles)
        return Error{fmt::format("found {}, expected at most {}; --max-triangles allows more", what,
                                 max_triangles)};
    if (census.triangles > kMaxTriangles)
        return Error{fmt::format("found {}, expected at most {}", what, kMaxTriangles)};
    const uint64_t bytes =
        plus(times(census.kept, kTriangleBytes),
             times(std::min(census.instances, census.triangles), kInstanceBytes));
    const uint64_t available = available_memory();
    if (is_held && bytes > available)
        return Error{fmt::format("found {}, which take {} MiB where {} MiB of memory are free",
                                 what, bytes >> 20, available >> 20)};
    return Done{};
}

Result<Done> check_conversion(const Census& census, uint64_t host_bytes) {
    const uint64_t bytes =
        plus(times(census.kept, kBytesToConvert),
             times(std::min(census.instances, census.triangles), kInstanceBytes));
    if (bytes > host_bytes)
        return Error{fmt::format("found objects that share their triangles, which is built in "
                                 "memory alone: {} triangles and {} instances take {} bytes of "
                                 "host memory, and {} are allowed: the smallest number that works "
                                 "is {}",
                                 census.kept, shown(census.instances), bytes, host_bytes, bytes)};
    return Done{};
}

} // namespace ovc::pbrt
