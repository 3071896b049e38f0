// SPDX-License-Identifier: Apache-2.0
// The table of contenders, the choice among them, and how each is built.
#include "host/bench/contender.h"

#include "core/file/scene_on_disk.h"
#include "core/text/suggestion.h"
#include "host/bench/float_kd_tree.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>

namespace ovc {

static Contender thesis(std::string_view name, BackendKind backend, uint32_t textures = 0) {
    return {
        .name = name, .kind = ContenderKind::Thesis, .leaves = {textures, ""}, .backend = backend};
}

static const Contender kContenders[] = {
    {"certified-fragment", ContenderKind::TwoLevel, OVC_PRECISION_CERTIFIED, OVC_KERNEL_FRAGMENT},
    {"certified-compute", ContenderKind::TwoLevel, OVC_PRECISION_CERTIFIED, OVC_KERNEL_COMPUTE},
    {"fast-fragment", ContenderKind::TwoLevel, OVC_PRECISION_FAST, OVC_KERNEL_FRAGMENT},
    {"fast-compute", ContenderKind::TwoLevel, OVC_PRECISION_FAST, OVC_KERNEL_COMPUTE},
    thesis("thesis-single-texture", BackendKind::SingleTexture),
    thesis("thesis-multi-texture", BackendKind::MultiTexture, /* textures= */ 4),
    thesis("thesis-gpu-grid", BackendKind::GpuGrid),
    thesis("thesis-gpu-kdtree", BackendKind::GpuKdTree),
    thesis("thesis-skip-bvh", BackendKind::SkipBvh),
    thesis("thesis-two-level", BackendKind::ThesisTwoLevel),
    {"cpu-kdtree", ContenderKind::CpuKdTree},
    {"cpu-float-kdtree", ContenderKind::FloatKdTree},
    {.name = "embree-medium", .kind = ContenderKind::Embree, .embree = EmbreeMode::Medium},
    {.name = "embree-high", .kind = ContenderKind::Embree, .embree = EmbreeMode::High},
    {.name = "embree-packets", .kind = ContenderKind::Embree, .embree = EmbreeMode::Packets},
    {.name = "embree-robust", .kind = ContenderKind::Embree, .embree = EmbreeMode::Robust},
};

std::string Contender::label() const {
    std::string text(name);
    if (!leaves.words.empty())
        text += fmt::format(", {} {}", leaves.words, leaves.words == "1" ? "leaf" : "leaves");
    if (!budget.words.empty())
        text += fmt::format(", budget {}", budget.words);
    if (!instances.words.empty())
        text += fmt::format(", {}", instances.words);
    return text;
}

std::vector<std::string_view> contender_names() {
    std::vector<std::string_view> names;
    for (const Contender& contender : kContenders)
        names.push_back(contender.name);
    return names;
}

static bool answers_to(std::string_view name, std::string_view word) {
    return name.starts_with(word) && (name.size() == word.size() || name[word.size()] == '-');
}

static Result<Done> check_names(std::span<const std::string> only) {
    const std::vector<std::string_view> names = contender_names();
    for (const std::string& word : only)
        if (std::none_of(names.begin(), names.end(),
                         [&](std::string_view name) { return answers_to(name, word); }))
            return Error{fmt::format("--only: there is no contender '{}'; there are {}{}", word,
                                     fmt::join(names, ", "), did_you_mean(word, names))};
    return Done{};
}

bool has_embree() {
    return bool(make_embree_backend(Soup{}, EmbreeMode::Medium));
}

static bool wanted(const Contender& contender, std::span<const std::string> only) {
    if (only.empty())
        return contender.kind != ContenderKind::Thesis &&
               (contender.kind != ContenderKind::Embree || has_embree());
    return std::any_of(only.begin(), only.end(),
                       [&](const std::string& word) { return answers_to(contender.name, word); });
}

Result<std::vector<Contender>> choose_contenders(std::span<const std::string> only,
                                                 std::span<const LeavesChoice> leaves,
                                                 std::span<const BudgetChoice> budgets,
                                                 std::span<const InstancesChoice> instances) {
    assert(!leaves.empty() && !budgets.empty() && !instances.empty());
    if (const Result<Done> known = check_names(only); !known)
        return known.error();
    std::vector<Contender> chosen;
    for (Contender contender : kContenders) {
        if (!wanted(contender, only))
            continue;
        if (contender.kind != ContenderKind::TwoLevel) {
            chosen.push_back(contender);
            continue;
        }
        for (const LeavesChoice& leaf_choice : leaves)
            for (const BudgetChoice& budget : budgets)
                for (const InstancesChoice& instances_choice : instances) {
                    contender.leaves = leaf_choice;
                    contender.budget = budget;
                    contender.instances = instances_choice;
                    chosen.push_back(contender);
                }
    }
    return chosen;
}

ContenderBuilder::ContenderBuilder(const Soup& soup, const KdTree* tree, double tree_seconds,
                                   std::string device, LogSink log)
    : soup_(soup),
      tree_(tree),
      tree_seconds_(tree_seconds),
      device_(std::move(device)),
      log_(std::move(log)) {}

Result<std::unique_ptr<Backend>> ContenderBuilder::build(const Contender& contender) {
    switch (contender.kind) {
    case ContenderKind::TwoLevel:
    case ContenderKind::Thesis:
        return build_on_gpu(contender);
    case ContenderKind::Embree:
        return make_embree_backend(soup_, contender.embree);
    case ContenderKind::FloatKdTree:
    case ContenderKind::CpuKdTree:
        break;
    }
    if (!tree_)
        return Error{fmt::format("found {} triangles, with those that are placed again, expected "
                                 "at most {} for a tree on the CPU: leave it out by --only, such "
                                 "as --only certified-compute",
                                 soup_.triangle_count(), kMaxCpuTreeTriangles)};
    if (contender.kind == ContenderKind::FloatKdTree)
        return make_float_kd_backend(soup_, *tree_);
    return make_cpu_backend(soup_, *tree_, tree_seconds_);
}

Soup baked(const Soup& soup) {
    Soup result;
    for (const Chunk& chunk : soup.chunks) {
        std::vector<dvec3> corners;
        corners.reserve(3 * size_t(chunk.size()));
        for (uint32_t prim = 0; prim < chunk.size(); ++prim)
            for (const dvec3& corner : chunk.triangle(prim))
                corners.push_back(corner);
        result.chunks.push_back(Chunk::owning_doubles(dvec3(0), std::move(corners)));
        result.chunks.back().set_mask(chunk.mask());
    }
    return result;
}

/// Returns the bytes of all pages, measured by building the scene with these options and the
/// device's default budget. Each number of leaves is built once.
Result<uint64_t> ContenderBuilder::all_pages_bytes(const Contender& contender,
                                                   BackendOptions options) {
    const std::pair key(contender.instances.baked, options.leaves);
    const auto known = pages_bytes_.find(key);
    if (known != pages_bytes_.end())
        return known->second;
    options.gpu_memory = {};
    const Result<const Soup*> soup = soup_for(contender);
    if (!soup)
        return soup.error();
    const Result<std::unique_ptr<Backend>> whole = make_backend(**soup, options, log_);
    if (!whole)
        return whole.error();
    return pages_bytes_[key] = (*whole)->statistics().level2_bytes;
}

/// Returns the scene as the contender is to have it. Error: baked, in 72 bytes a triangle, it would
/// be too large.
Result<const Soup*> ContenderBuilder::soup_for(const Contender& contender) {
    if (!contender.instances.baked)
        return &soup_;
    constexpr uint64_t kMaxBakedTriangles = 200'000'000;
    if (soup_.triangle_count() > kMaxBakedTriangles)
        return Error{fmt::format("found {} triangles, with those that are placed again, expected "
                                 "at most {} for --instances baked",
                                 soup_.triangle_count(), kMaxBakedTriangles)};
    if (!baked_)
        baked_ = baked(soup_);
    return &*baked_;
}

Result<std::unique_ptr<Backend>> ContenderBuilder::build_on_gpu(const Contender& contender) {
    BackendOptions options;
    options.kind = contender.backend;
    options.device = device_;
    options.precision = contender.precision;
    if (contender.kernel_variant.empty())
        options.kernel = contender.kernel;
    options.kernel_variant = contender.kernel_variant;
    options.leaves = contender.leaves.leaves;
    options.gpu_memory = contender.budget.memory;
    options.ranks_own = ranks_own_;
    options.on_disk = on_disk_;
    options.host_bytes = on_disk_ ? on_disk_->budget_bytes() : 0;
    options.host_shares = host_shares_;
    if (contender.budget.pages_share > 0) {
        const Result<uint64_t> bytes = all_pages_bytes(contender, options);
        if (!bytes)
            return bytes.error();
        options.gpu_memory.bytes =
            std::max(uint64_t(1), uint64_t(contender.budget.pages_share * double(*bytes)));
    }
    const Result<const Soup*> soup = soup_for(contender);
    return soup ? make_backend(**soup, options, log_) : soup.error();
}

} // namespace ovc
