// SPDX-License-Identifier: Apache-2.0
// Contender: who is timed. Two-level in each precision and kernel, under each of the settings that
// are swept; the systems of the thesis; and the peers on the CPU.
#pragma once

#include "core/result.h"
#include "host/backend/backend.h"
#include "kdtree/tree.h"

#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ovc {

enum class ContenderKind { TwoLevel, Thesis, CpuKdTree, FloatKdTree, Embree };

/// A value of a sweep over the plugin's settings, and the words it was asked for with; empty: not
/// asked.
struct LeavesChoice {
    uint32_t leaves = 0;
    std::string words;
};
struct BudgetChoice {
    MemorySize memory;      // neither bytes nor share: the device's default
    double pages_share = 0; // instead, where above 0: of the bytes of all pages
    std::string words;
};

struct Contender {
    std::string_view name; // "certified-fragment"
    ContenderKind kind;
    ovc_precision precision = OVC_PRECISION_CERTIFIED;
    ovc_kernel kernel = OVC_KERNEL_AUTO;
    EmbreeMode embree = EmbreeMode::Medium;
    LeavesChoice leaves;
    BudgetChoice budget;
    BackendKind backend = BackendKind::TwoLevel; // on the GPU: which

    /// The name, and the words of its sweep: "certified-fragment, 8 leaves, budget 12M".
    std::string label() const;
    bool on_gpu() const { return kind == ContenderKind::TwoLevel || kind == ContenderKind::Thesis; }
    bool certified() const { return on_gpu() && precision == OVC_PRECISION_CERTIFIED; }
};

/// All names, in the order of the table.
std::vector<std::string_view> contender_names();

/// only: names, or their first words ("certified", "embree"); empty: all that this program was
/// built with, but the systems of the thesis, some of which take long to build. Each contender of
/// two-level comes once for each pair of leaves and budget; both
/// lists have at least one value. Error: a name that there is none of.
Result<std::vector<Contender>> choose_contenders(std::span<const std::string> only,
                                                 std::span<const LeavesChoice> leaves,
                                                 std::span<const BudgetChoice> budgets);

/// Builds contenders over one soup, which outlives them.
class ContenderBuilder {
public:
    /// tree: over the soup, for the contenders cpu-kdtree and cpu-float-kdtree, which it outlives;
    /// null where they do not take part. tree_seconds: what building it took.
    ContenderBuilder(const Soup& soup, const KdTree* tree, double tree_seconds, std::string device,
                     LogSink log);
    Result<std::unique_ptr<Backend>> build(const Contender& contender);

private:
    Result<std::unique_ptr<Backend>> build_on_gpu(const Contender& contender);
    Result<uint64_t> all_pages_bytes(BackendOptions options);

    const Soup& soup_;
    const KdTree* tree_;
    double tree_seconds_;
    std::string device_;
    LogSink log_;
    std::map<uint32_t, uint64_t> pages_bytes_; // by leaves
};

/// Whether this program was built with Embree.
bool has_embree();

} // namespace ovc
