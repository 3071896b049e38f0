// SPDX-License-Identifier: Apache-2.0
// Threads shade the answers in blocks; then the rays of all blocks are joined in order.
#include "host/shade/shading.h"

#include "core/system/parallel.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

namespace ovc {

static constexpr size_t kBlock = 256;         // answers a task, whose rays fit a cache
static constexpr size_t kShadingGrain = 1024; // rays a task that only copies or adds up
static constexpr size_t kMaxAnswers = size_t(1) << 16;
/// So many blocks a thread at once keep all threads at work; the rays of blocks lie in memory
/// twice.
static constexpr size_t kBlocksAThread = 32;
static constexpr size_t kMaxSpawned = size_t(1) << 18;

Shading::Shading(const Integrator& integrator, Film& film)
    : integrator_(integrator),
      max_answers_(std::clamp(kMaxSpawned / (integrator.max_shadow_rays() + 2), kBlock,
                              std::min(kMaxAnswers, kBlocksAThread * kBlock * thread_count()))),
      film_(film) {}

/// Makes room behind `to` for the rays of the blocks, and returns where those of each begin.
template <class Purpose>
static std::vector<size_t> make_room(std::span<const Spawned> blocks,
                                     RayList<Purpose> Spawned::*list, RayList<Purpose>& to) {
    std::vector<size_t> places(blocks.size());
    size_t size = to.size();
    for (size_t b = 0; b < blocks.size(); ++b)
        places[b] = std::exchange(size, size + (blocks[b].*list).size());
    to.resize(size);
    return places;
}

/// Appends the rays of the blocks in their order.
static void append(std::span<const Spawned> blocks, Spawned& to) {
    const std::vector<size_t> paths = make_room(blocks, &Spawned::paths, to.paths);
    const std::vector<size_t> shadows = make_room(blocks, &Spawned::shadows, to.shadows);
    parallel_for(blocks.size(), kShadingGrain / kBlock, [&](size_t first, size_t last) {
        for (size_t b = first; b < last; ++b) {
            to.paths.put(paths[b], blocks[b].paths);
            to.shadows.put(shadows[b], blocks[b].shadows);
        }
    });
}

void Shading::shade(const RayList<Path>& paths, std::span<const Hit> hits, size_t first,
                    size_t count, Spawned& spawned) {
    assert(hits.size() == paths.size() && first + count <= hits.size());
    const size_t block_count = (count + kBlock - 1) / kBlock;
    blocks_.resize(std::max(blocks_.size(), block_count));
    parallel_for(block_count, 1, [&](size_t from, size_t to) {
        for (size_t b = from; b < to; ++b)
            shade_block(paths, hits, first + b * kBlock, std::min(kBlock, count - b * kBlock),
                        blocks_[b]);
    });
    append(std::span(blocks_).first(block_count), spawned);
}

void Shading::shade_block(const RayList<Path>& paths, std::span<const Hit> hits, size_t first,
                          size_t count, Spawned& spawned) {
    const auto part = [&](const auto& all) { return std::span(all).subspan(first, count); };
    spawned.clear();
    integrator_.shade(part(paths.rays), part(paths.purposes), hits.subspan(first, count), film_,
                      spawned);
    for (const Path& path : spawned.paths.purposes)
        film_.open(path.pixel);
    const std::span<const Path> answered = part(paths.purposes);
    const std::span<const Shadow> shadows = spawned.shadows.purposes;
    // A path that ends and a shadow ray that begins leave their pixel's count as it is.
    std::array<uint32_t, kBlock> closed;
    size_t next = 0, closes = 0;
    for (const Path& path : answered)
        if (next < shadows.size() && shadows[next].pixel == path.pixel)
            ++next;
        else
            closed[closes++] = path.pixel;
    for (; next < shadows.size(); ++next)
        film_.open(shadows[next].pixel);
    Film::Answers answers(film_);
    for (size_t i = 0; i < closes; ++i)
        answers.close(closed[i]);
}

void Shading::arrive(std::span<const Shadow> purposes, std::span<const uint8_t> occluded) {
    assert(occluded.size() == purposes.size());
    parallel_for(purposes.size(), kShadingGrain, [&](size_t first, size_t last) {
        Film::Answers answers(film_);
        for (size_t i = first; i < last; ++i)
            if (occluded[i])
                answers.close(purposes[i].pixel);
            else
                answers.close(purposes[i].pixel, purposes[i].arriving);
    });
}

void Shading::pass(RayList<Shadow>& shadows, std::span<const Hit> hits) {
    assert(hits.size() == shadows.size());
    goes_on_.resize(shadows.size());
    parallel_for(shadows.size(), kBlock, [&](size_t first, size_t last) {
        Film::Answers answers(film_);
        for (size_t i = first; i < last; ++i) {
            Shadow& shadow = shadows.purposes[i];
            goes_on_[i] = hits[i].is_hit() && integrator_.pass(hits[i], shadows.rays[i], shadow);
            if (goes_on_[i]) {
                shadows.skip[i] = hits[i].id;
                continue;
            }
            answers.close(shadow.pixel, shadow.arriving);
        }
    });
    size_t kept = 0;
    for (size_t i = 0; i < shadows.size(); ++i)
        if (goes_on_[i]) {
            shadows.rays[kept] = shadows.rays[i];
            shadows.skip[kept] = shadows.skip[i];
            shadows.purposes[kept++] = shadows.purposes[i];
        }
    shadows.resize(kept);
}

} // namespace ovc
