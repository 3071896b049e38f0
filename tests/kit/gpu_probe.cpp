// SPDX-License-Identifier: Apache-2.0
// Measures what a device does besides tracing: how large a pool it gives, how fast pages move to
// it, and whether they move while a pass runs. Prints one JSON object.
// usage: gpu_probe [SECONDS [DEVICE]]     SECONDS: about how long it may take; default 20
#include "core/system/stopwatch.h"
#include "core/text/format_text.h"
#include "gpu/gl/gl_check.h"
#include "gpu/gl/gl_thread.h"
#include "gpu/page/top_level.h"
#include "gpu/trace/tracer.h"
#include "kdtree/partition.h"
#include "kdtree/test_soups.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <random>
#include <string>
#include <vector>

namespace ovc {
namespace {

/// Returns a list in JSON of what each(size) returns for all sizes.
template <class Each>
std::string list_of(const std::vector<uint64_t>& sizes, Each&& each) {
    std::string list;
    for (const uint64_t size : sizes)
        list += (list.empty() ? "" : ", ") + each(size);
    return "[" + list + "]";
}

/// Allocates a pool of so many bytes, and writes a page to its beginning and to its end.
std::string allocate(uint64_t bytes, const DeviceInfo& device) {
    Ledger ledger;
    ledger.budget = bytes;
    ledger.takes_host_pages = device.takes_host_pages;
    const Stopwatch watch;
    const PoolLayout layout{bytes, device.max_buffer_texels * sizeof(uvec4)};
    std::string error = "null";
    {
        const Uploads uploads(device.passes_in_flight > 1, bytes);
        Pool pool(ledger, uploads, layout, 1);
        const std::vector<uvec4> page(4096);
        if (const Result<Done> made = check_gl("allocating"); !made || ledger.refused) {
            error = "\"the driver refuses\"";
        } else {
            pool.show();
            pool.upload(0, page);
            pool.upload(bytes - 4096 * sizeof(uvec4), page);
            glFinish();
        }
    }
    return format_text("{\"bytes\": {}, \"buffers\": {}, \"seconds\": {}, \"error\": {}}"
                       "",
                       bytes, layout.count(), watch.seconds(), error);
}

/// Moves pages of so many bytes for a while.
std::string upload(uint64_t page_bytes, double seconds, const DeviceInfo& device) {
    Ledger ledger;
    const uint64_t pool_bytes = std::max<uint64_t>(128 << 20, page_bytes);
    ledger.budget = pool_bytes;
    ledger.takes_host_pages = device.takes_host_pages;
    const Uploads uploads(device.passes_in_flight > 1, pool_bytes);
    Pool pool(ledger, uploads, {pool_bytes, device.max_buffer_texels * sizeof(uvec4)}, 1);
    pool.show();
    const std::vector<uvec4> page(page_bytes / sizeof(uvec4), uvec4(7));
    pool.upload(0, page);
    glFinish();
    const Stopwatch watch;
    uint64_t bytes = 0, offset = 0;
    while (watch.seconds() < seconds) {
        pool.upload(offset, page);
        bytes += page_bytes;
        offset = offset + 2 * page_bytes > pool_bytes ? 0 : offset + page_bytes;
        if (bytes % (64 << 20) == 0)
            glFinish(); // a driver must not gather everything until the end
    }
    glFinish();
    return format_text("{\"page_bytes\": {}, \"bytes_per_second\": {}}", page_bytes,
                       double(bytes) / watch.seconds());
}

/// A scene in leaves, half of which fit, and rays from everywhere.
struct MovingScene {
    Soup soup = test::random_soup(1, 200000, 0.02);
    Level1 level1;
    std::vector<Page> pages;
    TopLevel top;
    std::vector<RayState> rays;

    MovingScene() {
        Box bounds;
        const auto ids = hittable_triangles(soup, nullptr, &bounds);
        level1 = partition(soup, ids, bounds, uint32_t(ids.size() / 32));
        share_frame(level1);
        const Numbering numbers(soup);
        for (const Leaf& leaf : level1.leaves)
            pages.push_back(build_page(soup, numbers, leaf));
        top = build_top_level(pages, pages.size());
        test::Random random(2);
        rays.resize(1 << 17);
        for (RayState& state : rays)
            state.ray = {random.point(0, 1), 0, random.point(-1, 1)};
    }
};

/// Seconds a pass where each is waited for before the next is sent (passes = 1), or where as many
/// as `passes` are under way.
double seconds_a_pass(Tracer& tracer, std::span<SentRays> rays, Answers& answers, size_t passes) {
    constexpr size_t kPasses = 16;
    std::deque<Tracer::Pass> under_way;
    const Stopwatch watch;
    for (size_t i = 0; i < kPasses; ++i) {
        if (const Result<Tracer::Pass> sent = tracer.submit(rays[i % passes]))
            under_way.push_back(*sent);
        for (; under_way.size() >= (i + 1 < kPasses ? passes : 1); under_way.pop_front())
            if (!tracer.collect(under_way.front(), answers))
                return 1e9;
    }
    return watch.seconds() / double(kPasses);
}

/// Seconds of a pass alone, of moving half of the pages alone, and of both at once.
Result<std::string> overlap(GlState& state, const DeviceInfo& device, double seconds) {
    const MovingScene scene;
    uint64_t bytes = 0;
    for (const Page& page : scene.pages)
        bytes += page.bytes();
    MemoryPlan plan = *plan_memory(256 << 20, device);
    plan.pool_bytes = scene.top.room() + bytes * 5 / 8 / 4096 * 4096;
    auto tracer = Tracer::create(plan, {.variants = default_variants(device)}, device,
                                 state.kernels, scene.level1.bounds, scene.pages, scene.top);
    if (!tracer)
        return tracer.error();
    const size_t count = std::min<size_t>(scene.rays.size(), plan.batch_rays);
    SentRays rays = send((*tracer)->form(), std::span(scene.rays).first(count));
    Answers answers;
    double pass = 1e9, move = 1e9, both = 1e9, first = 0, alone = 1e9, behind = 1e9;
    uint64_t moved = 0;
    const Stopwatch watch;
    for (size_t round = 0; round < 3 || watch.seconds() < seconds; ++round) {
        const auto traced = [&](bool moves) {
            const Stopwatch one;
            const Result<Tracer::Pass> sent = (*tracer)->submit(rays);
            if (moves)
                moved = (*tracer)->bring((*tracer)->missing()).bytes;
            const Result<Done> done = sent ? (*tracer)->collect(*sent, answers) : sent.error();
            glFinish();
            return done ? one.seconds() : 1e9;
        };
        first = round == 0 ? traced(false) : first;
        const Stopwatch moving;
        (*tracer)->bring((*tracer)->missing());
        glFinish();
        move = std::min(move, moving.seconds());
        pass = std::min(pass, traced(false)); // through the same pages as the next
        both = std::min(both, traced(true));
        rays.unpart();
        std::array batches{rays.first(count), rays.first(count)};
        alone = std::min(alone, seconds_a_pass(**tracer, batches, answers, 1));
        behind = std::min(behind, seconds_a_pass(**tracer, batches, answers, plan.passes));
    }
    return format_text("{\"rays\": {}, \"first_pass_seconds\": {}, \"pass_seconds\": {}, "
                       "\"move_seconds\": {}, \"both_seconds\": {}, \"moved_bytes\": {}, "
                       "\"passes_under_way\": {}, \"one_by_one_seconds\": {}, "
                       "\"behind_seconds\": {}}",
                       count, first, pass, move, both, moved, plan.passes, alone, behind);
}

std::vector<uint64_t> pool_sizes(const DeviceInfo& device) {
    std::vector<uint64_t> sizes;
    const uint64_t all = device.memory_bytes / 65536 * 65536;
    for (uint64_t bytes = 64 << 20; bytes < all; bytes *= 4)
        sizes.push_back(bytes);
    sizes.push_back(all - all / 8 / 65536 * 65536);
    sizes.push_back(all);
    return sizes;
}

int probe(double seconds, const char* name) {
    Result<std::unique_ptr<GlThread>> gl = GlThread::start(name, {});
    if (!gl) {
        std::fprintf(stderr, "gpu_probe: %s\n", gl.error().message.c_str());
        return 1;
    }
    const DeviceInfo& device = (*gl)->info();
    return (*gl)->run([&](GlState& state) {
        const std::vector<uint64_t> pages{64 << 10, 512 << 10, 4 << 20, 32 << 20};
        const std::string pools =
            list_of(pool_sizes(device), [&](uint64_t size) { return allocate(size, device); });
        const std::string uploads =
            list_of(pages, [&](uint64_t size) { return upload(size, seconds / 8, device); });
        const Result<std::string> both = overlap(state, device, seconds / 3);
        if (!both) {
            std::fprintf(stderr, "gpu_probe: %s\n", both.error().message.c_str());
            return 1;
        }
        std::printf("{\"renderer\": \"%s\", \"memory_bytes\": %llu,\n \"pools\": %s,\n "
                    "\"uploads\": %s,\n \"overlap\": %s}\n",
                    device.renderer.c_str(), static_cast<unsigned long long>(device.memory_bytes),
                    pools.c_str(), uploads.c_str(), both->c_str());
        return 0;
    });
}

} // namespace
} // namespace ovc

int main(int count, char** arguments) {
    const double seconds = count > 1 ? std::atof(arguments[1]) : 20;
    return ovc::probe(seconds > 0 ? seconds : 20, count > 2 ? arguments[2] : "");
}
