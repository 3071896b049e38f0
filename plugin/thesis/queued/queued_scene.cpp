// SPDX-License-Identifier: Apache-2.0
// QueuedScene: builds level 1, then a page for each leaf, then the pool.
#include "plugin/thesis/queued/queued_scene.h"

#include "core/system/parallel.h"
#include "core/system/stopwatch.h"
#include "core/text/format_text.h"
#include "plugin/thesis/queued/hittable.h"
#include "shaders/layout.h"

#include <algorithm>
#include <cassert>

namespace ovc::thesis {
namespace {

constexpr uint64_t kPagesAtOnce = 3;    // the pool holds so many of the largest pages
constexpr uint64_t kDefaultLeaves = 10; // thesis, section 4

/// The bytes of a triangle in a page where most triangles pair up; soups without shared edges take
/// up to twice as much.
constexpr uint64_t kBytesPerTriangle = 52;

uint64_t max_triangles(const QueuedOptions& options, uint64_t triangles) {
    if (options.leaf_triangles)
        return options.leaf_triangles;
    const uint64_t leaves = options.leaves ? options.leaves : kDefaultLeaves;
    return std::max<uint64_t>((triangles + leaves - 1) / leaves, 1);
}

/// Builds all pages. Returns the number of the largest.
size_t build_pages(QueuedScene& scene, BuildProgress* progress) {
    std::vector<Page>& pages = scene.built.pages;
    pages.clear();
    pages.resize(scene.built.level1.leaves.size());
    parallel_for(pages.size(), 1, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i)
            pages[i] = build_page(scene.built.soup, scene.built.numbers,
                                  scene.built.level1.leaves[i], progress);
    });
    const auto largest = std::max_element(pages.begin(), pages.end(),
                                          [](auto& a, auto& b) { return a.bytes() < b.bytes(); });
    assert(!pages.empty());
    return size_t(largest - pages.begin());
}

/// Builds both levels, and again with smaller leaves while a page is too large.
Result<Done> build_levels(QueuedScene& scene, const Level1Builder& builder, uint64_t max_triangles,
                          BuildProgress* progress) {
    const uint64_t page_bytes = scene.plan.pool_bytes / kPagesAtOnce;
    max_triangles =
        std::clamp<uint64_t>(std::min(max_triangles, page_bytes / kBytesPerTriangle), 1, kNone);
    while (true) {
        Stopwatch watch;
        scene.built.level1 = builder.cut(uint32_t(max_triangles), scene.walk);
        scene.statistics.seconds_level1 += watch.seconds();
        watch = Stopwatch();
        const size_t largest = build_pages(scene, progress);
        scene.statistics.seconds_level2 += watch.seconds();
        const uint64_t bytes = scene.built.pages[largest].bytes();
        if (bytes <= page_bytes) {
            scene.built.top = build_top_level(scene.built.level1, scene.built.pages,
                                              scene.built.pages.size()); // for the exact fallback
            return Done{};
        }
        if (max_triangles == 1)
            return over_budget(
                format_text("a page of one triangle does not fit into {} bytes", page_bytes));
        // The bytes per triangle of this page, and a little more, tell how many triangles fit.
        const double triangles = double(scene.built.level1.leaves[largest].triangles.size());
        const uint64_t fit = uint64_t(0.95 * double(page_bytes) / double(bytes) * triangles);
        max_triangles = std::clamp<uint64_t>(fit, 1, max_triangles - 1);
    }
}

void count(QueuedScene& scene) {
    ovc_statistics& statistics = scene.statistics;
    statistics.leaves = scene.built.level1.leaves.size();
    statistics.leaf_references = scene.built.level1.reference_count();
    statistics.level2_bytes = scene.built.level2_bytes();
    statistics.largest_page_bytes = scene.built.largest_page_bytes();
}

Result<Done> make_passes(QueuedScene& scene) {
    scene.plan.pool_bytes = std::min(scene.plan.pool_bytes, scene.statistics.level2_bytes);
    Result<std::unique_ptr<LeafPasses>> passes = Error{};
    scene.gl.run([&](GlState&) {
        passes = LeafPasses::create(scene.plan, scene.gl.info(), scene.built.pages, scene.certify);
    });
    if (!passes)
        return passes.error();
    scene.passes = std::move(*passes);
    scene.statistics.gpu_peak_bytes = scene.passes->ledger().peak;
    return Done{};
}

} // namespace

QueuedScene::~QueuedScene() {
    if (passes)
        gl.run([&](GlState&) { passes.reset(); });
}

Result<std::unique_ptr<QueuedScene>> build_queued_scene(const Soup& soup, GlThread& gl,
                                                        const QueuedOptions& options,
                                                        const LogSink& log,
                                                        BuildProgress* progress) {
    if (soup.triangle_count() > OVC_MAX_TRIANGLES)
        return Error{format_text("{} triangles are too many: a scene takes {}",
                                 soup.triangle_count(), OVC_MAX_TRIANGLES),
                     ErrorKind::InvalidArgument};
    auto scene = std::make_unique<QueuedScene>(soup, gl, options.certify);
    const Result<ovc::MemoryPlan> plan = LeafPasses::plan_memory(
        options.budget_bytes ? options.budget_bytes : gl.info().default_budget_bytes(), gl.info());
    if (!plan)
        return plan.error();
    scene->plan = *plan;
    scene->plan.pool_bytes = std::min(plan->pool_bytes, plan->buffer_bytes); // one buffer
    scene->statistics.gpu_budget_bytes = plan->budget_bytes;
    const Stopwatch watch;
    begin(progress, "triangles", 0.1, 2 * soup.triangle_count());
    const Hittable hittable = take_hittable(scene->built, scene->statistics, log, progress);
    if (hittable.triangles.empty())
        return scene;
    begin(progress, "levels 1 and 2", 0.9, 5 * hittable.triangles.size());
    const Level1Builder builder(soup, hittable.triangles, hittable.bounds, options.level1,
                                options.build, progress);
    scene->statistics.seconds_level1 = watch.seconds();
    if (Result<Done> built = build_levels(
            *scene, builder, max_triangles(options, hittable.triangles.size()), progress);
        !built)
        return built.error();
    count(*scene);
    if (Result<Done> made = make_passes(*scene); !made)
        return made.error();
    return scene;
}

} // namespace ovc::thesis
