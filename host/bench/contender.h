// SPDX-License-Identifier: Apache-2.0
// A Contender is a backend with settings that the bench times: two-level in each precision and
// kernel, under each of the settings that are swept; the systems of the thesis; peers on the CPU.
#pragma once

#include "core/result.h"
#include "host/backend/backend.h"
#include "kdtree/tree.h"

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ovc {

enum class ContenderKind { TwoLevel, Thesis, CpuKdTree, FloatKdTree, Embree };

/// Values of sweeps over the plugin's settings. `words` is how the user asked for the value; it is
/// empty where the user asked for none.
struct LeavesChoice {
    uint32_t leaves = 0;
    std::string words;
};
struct InstancesChoice {
    bool baked = false; // as triangles of their own, instead of sharing pages
    std::string words;
};
struct BudgetChoice {
    MemorySize memory;      // neither bytes nor share: the device's default
    double pages_share = 0; // above 0: a share of the bytes of all pages, instead of `memory`
    std::string words;
};

struct Contender {
    std::string_view name; // "certified-fragment"
    ContenderKind kind;
    ovc_precision precision = OVC_PRECISION_CERTIFIED;
    ovc_kernel kernel = OVC_KERNEL_AUTO;
    std::string kernel_variant; // of the plugin; empty: the kernel's default
    EmbreeMode embree = EmbreeMode::Medium;
    LeavesChoice leaves;
    BudgetChoice budget;
    InstancesChoice instances;
    BackendKind backend = BackendKind::TwoLevel; // read where on_gpu()

    /// Returns the name with the values of its sweep: "certified-fragment, 8 leaves, budget 12M".
    std::string label() const;
    bool on_gpu() const { return kind == ContenderKind::TwoLevel || kind == ContenderKind::Thesis; }
    bool certified() const { return on_gpu() && precision == OVC_PRECISION_CERTIFIED; }
};

/// Returns all names, in the order of the table in contender.cpp.
std::vector<std::string_view> contender_names();

/// Returns the contenders that `only` asks for, by names or their first words ("certified",
/// "embree"). An empty `only` asks for all that this program was built with, except the systems of
/// the thesis, some of which take long to build. Each two-level contender comes once for each
/// combination of values; all lists have at least one (asserted). Error: an unknown name.
Result<std::vector<Contender>> choose_contenders(std::span<const std::string> only,
                                                 std::span<const LeavesChoice> leaves,
                                                 std::span<const BudgetChoice> budgets,
                                                 std::span<const InstancesChoice> instances);

/// The max triangles of a KD-tree on the CPU, which holds each placed one, in some 150 bytes.
inline constexpr uint64_t kMaxCpuTreeTriangles = 100'000'000;

/// Returns a soup of the same triangles, by the same ids, in which each chunk has corners of its
/// own: those of its placed triangles, in double.
Soup baked(const Soup& soup);

/// Builds contenders over one soup, which must outlive them.
class ContenderBuilder {
public:
    /// tree: over the soup, for the contenders cpu-kdtree and cpu-float-kdtree, which it outlives;
    /// null where they do not take part or the scene is too large. tree_seconds: what building it
    /// took.
    ContenderBuilder(const Soup& soup, const KdTree* tree, double tree_seconds, std::string device,
                     LogSink log);
    /// Lets the contenders read a scene that lies on a disk, which outlives them. contenders: that
    /// share its budget.
    void read_from(const SceneOnDisk& disk, size_t contenders) {
        on_disk_ = &disk;
        host_shares_ = uint32_t(contenders);
    }
    Result<std::unique_ptr<Backend>> build(const Contender& contender);
    /// Says which leaves ranks have of scenes that are built from now on.
    void set_ranks_own(ovc_ranks_own own) { ranks_own_ = own; }

private:
    Result<std::unique_ptr<Backend>> build_on_gpu(const Contender& contender);
    Result<uint64_t> all_pages_bytes(const Contender& contender, BackendOptions options);
    Result<const Soup*> soup_for(const Contender& contender);

    const Soup& soup_;
    std::optional<Soup> baked_; // made when a contender wants it
    const KdTree* tree_;
    double tree_seconds_;
    std::string device_;
    LogSink log_;
    ovc_ranks_own ranks_own_ = OVC_RANKS_OWN_AUTO;
    const SceneOnDisk* on_disk_ = nullptr;
    uint32_t host_shares_ = 1;
    std::map<std::pair<bool, uint32_t>, uint64_t> pages_bytes_; // by whether baked, and leaves
};

/// Returns whether this program was built with Embree.
bool has_embree();

} // namespace ovc
