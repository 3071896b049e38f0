// SPDX-License-Identifier: Apache-2.0
#include "gpu/trace/packets.h"

#include "core/system/parallel.h"
#include "gpu/trace/answers.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstring>

namespace ovc {
namespace {

constexpr size_t kMaxLeftShare = 1024; // at most one ray in so many may find no room

const LocalRay& local(const LocalRay& ray) {
    return ray;
}
const LocalRay& local(const ResumedRay& ray) {
    return ray.ray;
}
void remove(LocalRay& ray) {
    ray.t_end = OVC_NO_RAY;
}
void remove(ResumedRay& ray) {
    remove(ray.ray);
}

bool near(const vec3& a, const vec3& b) {
    constexpr float kNear = 1.0f / 16;
    const vec3 apart = abs(a - b);
    return std::max({apart.x, apart.y, apart.z}) < kNear;
}

/// Four floats, and truth (-1) or not (0) of each.
typedef float Four __attribute__((vector_size(16)));
typedef int Mask __attribute__((vector_size(16)));

/// Returns the direction; the fourth element may be anything.
Four direction(const LocalRay& ray) {
    static_assert(offsetof(LocalRay, dir) + sizeof(Four) <= sizeof(LocalRay));
    Four four;
    std::memcpy(&four, &ray.dir, sizeof(four));
    return four;
}

/// Whether both rays go into the same octant and farthest along the same axis, as the kernel sees
/// it (shaders/triangle.glsl): -0 is not negative, and the largest component is 1 or -1.
bool go_alike(const LocalRay& a, const LocalRay& b) {
    const Four x = direction(a), y = direction(b);
    const Mask other_sign = (x < 0) ^ (y < 0);
    const Mask other_axis = ((x == 1) | (x == -1)) ^ ((y == 1) | (y == -1));
    const Mask differ = other_sign | (other_axis & Mask{0, -1, -1, 0});
    return (differ[0] | differ[1] | differ[2]) == 0;
}

/// Returns the second rays of all packets whose two rays do not go alike.
template <class Sent>
std::vector<uint32_t> apart(std::span<const Sent> rays) {
    using Numbers = std::vector<uint32_t>;
    Numbers numbers = parallel_reduce(
        rays.size() / kPacketRays, Numbers(),
        [&](size_t first, size_t last, Numbers found) {
            for (size_t pair = first; pair < last; ++pair) {
                const LocalRay &a = local(rays[2 * pair]), &b = local(rays[2 * pair + 1]);
                if (!go_alike(a, b) && a.t_end >= 0 && b.t_end >= 0)
                    found.push_back(uint32_t(2 * pair + 1));
            }
            return found;
        },
        [](Numbers a, const Numbers& b) {
            a.insert(a.end(), b.begin(), b.end());
            return a;
        });
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

template <class Sent>
std::optional<std::vector<Parted>> part(PagedVector<Sent>& slots, size_t rays, size_t max_slots) {
    static_assert(kPacketRays == 2);
    assert(rays <= slots.size() && slots.size() <= max_slots);
    const std::vector<uint32_t> numbers = apart(std::span<const Sent>(slots).first(rays));
    std::vector<Parted> parted;
    size_t end = rays + rays % 2;
    for (const uint32_t number : numbers) {
        // It goes beside the ray parted before, if the two go alike.
        const bool second =
            end % 2 == 1 && go_alike(local(slots[parted.back().ray]), local(slots[number]));
        const size_t slot = second ? end : end + end % 2;
        if (slot >= max_slots)
            break;
        parted.push_back({number, uint32_t(slot)});
        end = slot + 1;
    }
    if (numbers.size() - parted.size() > rays / kMaxLeftShare)
        return {};
    Sent none{};
    remove(none);
    slots.resize(std::max(slots.size(), whole_blocks(end)), none);
    for (const auto& [ray, slot] : parted) {
        slots[slot] = slots[ray];
        remove(slots[ray]);
    }
    return parted;
}

} // namespace

bool coherent(size_t rays, FunctionRef<LocalRay(size_t)> ray_at) {
    constexpr size_t kStep = 64;
    size_t pairs = 0, together = 0;
    for (size_t i = 0; i + 1 < rays; i += kStep) {
        const LocalRay a = ray_at(i), b = ray_at(i + 1);
        if (a.t_end < 0 || b.t_end < 0)
            continue;
        pairs += 1;
        together += near(a.dir, b.dir) && near(a.org, b.org);
    }
    return 2 * together >= pairs;
}
bool coherent(std::span<const LocalRay> rays) {
    return coherent(rays.size(), [&](size_t i) { return rays[i]; });
}

std::optional<std::vector<Parted>> part_packets(PagedVector<LocalRay>& slots, size_t rays,
                                                size_t max_slots) {
    return part(slots, rays, max_slots);
}
std::optional<std::vector<Parted>> part_packets(PagedVector<ResumedRay>& slots, size_t rays,
                                                size_t max_slots) {
    return part(slots, rays, max_slots);
}

} // namespace ovc
