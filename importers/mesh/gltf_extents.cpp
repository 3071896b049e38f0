// SPDX-License-Identifier: Apache-2.0
// Source: Khronos, "glTF 2.0", sections 3.5 (nodes) and 3.6 (buffers, views, accessors).
#include "importers/mesh/gltf_extents.h"

#include "importers/file/available_memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace ovc {

namespace {

using Json = nlohmann::json;

/// Larger numbers are refused, so that no product of a count and a stride overflows.
constexpr uint64_t kMaxBytes = uint64_t(1) << 40, kMaxCount = uint64_t(1) << 32;
constexpr uint64_t kMaxStride = 255; // after 3.6.2.4, 252

/// The max depth of the tree of nodes.
constexpr size_t kMaxLevels = 1000;
/// The max nodes below one another, where a node below two counts twice.
constexpr uint64_t kMaxNodes = 10'000'000;

uint64_t component_bytes(uint64_t type) {
    switch (type) {
    case 5120:
    case 5121:
        return 1;
    case 5122:
    case 5123:
        return 2;
    case 5125:
    case 5126:
        return 4;
    default:
        return 0;
    }
}

uint64_t components(std::string_view type) {
    constexpr std::pair<std::string_view, uint64_t> kTypes[] = {
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
        {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
    for (const auto& [name, count] : kTypes)
        if (name == type)
            return count;
    return 0;
}

class Extents {
public:
    explicit Extents(const Json& gltf) : gltf_(gltf) {}

    std::optional<std::string> first_fault() {
        check_all("bufferViews", &Extents::check_view);
        check_all("accessors", &Extents::check_accessor);
        check_nodes();
        return fault_;
    }

private:
    /// Returns an array of the file; an empty one if the file has none of that name.
    const Json& array(const std::string& name) const {
        static const Json none = Json::array();
        const auto at = gltf_.find(name);
        return at == gltf_.end() || !at->is_array() ? none : *at;
    }

    void check_all(const std::string& name, void (Extents::*check)(const Json&, std::string)) {
        const Json& all = array(name);
        for (size_t i = 0; i < all.size() && !fault_; ++i)
            if (all[i].is_object())
                (this->*check)(all[i], fmt::format("{}[{}]", name, i));
    }

    /// Keeps the first fault.
    void fail(std::string sentence) {
        if (!fault_)
            fault_ = std::move(sentence);
    }

    /// Returns a number up to `max`; `otherwise`, or a fault if that is none, where it is missing.
    uint64_t number(const Json& of, const char* key, const std::string& place, uint64_t max,
                    std::optional<uint64_t> otherwise = {}) {
        const auto at = of.find(key);
        if (at == of.end() && otherwise)
            return *otherwise;
        if (at != of.end() && at->is_number_unsigned() && at->get<uint64_t>() <= max)
            return at->get<uint64_t>();
        fail(fmt::format("found {} as {} of {}, expected a number from 0 to {}",
                         at == of.end() ? "nothing" : at->dump().substr(0, 40), key, place, max));
        return 0;
    }

    /// Returns the element that of[key] counts to; null, and a fault, if there is none.
    const Json* element(const Json& of, const char* key, const char* name,
                        const std::string& place) {
        const Json& all = array(name);
        const uint64_t index = number(of, key, place, kMaxCount);
        if (!fault_ && index < all.size() && all[index].is_object())
            return &all[index];
        fail(fmt::format("found {} {} in {}, expected one of {}", key, index, place, all.size()));
        return nullptr;
    }

    void check_view(const Json& view, std::string place) {
        const Json* const buffer = element(view, "buffer", "buffers", place);
        if (!buffer)
            return;
        const uint64_t bytes = number(*buffer, "byteLength", "a buffer", kMaxBytes);
        const uint64_t first = number(view, "byteOffset", place, kMaxBytes, 0);
        const uint64_t length = number(view, "byteLength", place, kMaxBytes);
        if (first + length > bytes)
            fail(fmt::format("found {} at bytes {} to {}, expected no more than the {} of its "
                             "buffer",
                             place, first, first + length, bytes));
    }

    /// Checks `count` elements of some bytes, `stride` apart unless that is 0, in a view.
    void check_run(const Json& of, const std::string& place, uint64_t count, uint64_t bytes) {
        const Json* const view = element(of, "bufferView", "bufferViews", place);
        if (!view)
            return;
        const uint64_t first = number(of, "byteOffset", place, kMaxBytes, 0);
        const uint64_t stride = number(*view, "byteStride", place, kMaxStride, 0);
        const uint64_t length = number(*view, "byteLength", place, kMaxBytes);
        const uint64_t run = count == 0 ? 0 : (count - 1) * std::max(stride, bytes) + bytes;
        if (first + run > length)
            fail(fmt::format("found {} up to byte {}, expected no more than the {} of its view",
                             place, first + run, length));
    }

    void check_accessor(const Json& accessor, std::string place) {
        const uint64_t component =
            component_bytes(number(accessor, "componentType", place, kMaxCount));
        const auto type = accessor.find("type");
        const uint64_t bytes = type != accessor.end() && type->is_string()
                                   ? component * components(type->get_ref<const std::string&>())
                                   : 0;
        const uint64_t count = number(accessor, "count", place, kMaxCount);
        if (bytes == 0)
            fail(fmt::format("found no type and componentType in {} that glTF knows", place));
        if (!fault_ && accessor.contains("bufferView"))
            check_run(accessor, place, count, bytes);
        else if (count * bytes > available_memory()) // Assimp fills it with zeros
            fail(fmt::format("found {} of {} bytes, more than the memory that is free", place,
                             count * bytes));
        if (!fault_ && accessor.contains("sparse"))
            check_sparse(accessor["sparse"], place + ".sparse", count, bytes);
    }

    void check_sparse(const Json& sparse, const std::string& place, uint64_t of, uint64_t bytes) {
        for (const char* part : {"indices", "values"})
            if (!sparse.is_object() || !sparse.contains(part) || !sparse[part].is_object())
                return fail(fmt::format("found no {} in {}", part, place));
        const uint64_t count = number(sparse, "count", place, of);
        const Json& indices = sparse["indices"];
        const uint64_t index = component_bytes(number(indices, "componentType", place, kMaxCount));
        check_run(indices, place + ".indices", count, std::max<uint64_t>(index, 1));
        check_run(sparse["values"], place + ".values", count, bytes);
    }

    /// A node with all below it, as often as each is placed.
    struct Tree {
        enum class State : uint8_t { New, Open, Done } state = State::New;
        size_t levels = 1;
        uint64_t nodes = 1;
    };

    void check_nodes() {
        const Json& nodes = array("nodes");
        trees_.resize(nodes.size());
        for (size_t i = 0; i < nodes.size() && !fault_; ++i)
            measure(i, 1);
    }

    /// Measures each node once. depth: of this one below where we began.
    void measure(size_t index, size_t depth) {
        Tree& tree = trees_[index];
        if (tree.state == Tree::State::Done)
            return;
        if (tree.state == Tree::State::Open)
            return fail(fmt::format("found nodes[{}] among its own descendants", index));
        tree.state = Tree::State::Open;
        const Json& node = array("nodes")[index];
        const auto children = node.is_object() ? node.find("children") : node.end();
        if (children != node.end() && depth <= kMaxLevels)
            for (const Json& child : *children) {
                if (!child.is_number_unsigned() || child.get<uint64_t>() >= trees_.size())
                    continue; // Assimp says it
                measure(child.get<size_t>(), depth + 1);
                if (fault_)
                    return;
                const Tree& below = trees_[child.get<size_t>()];
                tree.levels = std::max(tree.levels, below.levels + 1);
                tree.nodes = std::min(tree.nodes + below.nodes, kMaxNodes + 1);
            }
        if (depth > kMaxLevels || tree.levels > kMaxLevels)
            fail(fmt::format("found nodes[{}] over more than {} levels of others", index,
                             kMaxLevels));
        if (tree.nodes > kMaxNodes)
            fail(fmt::format("found nodes[{}] over more than {} others", index, kMaxNodes));
        tree.state = Tree::State::Done;
    }

    const Json& gltf_;
    std::vector<Tree> trees_;
    std::optional<std::string> fault_;
};

} // namespace

std::optional<std::string> unsound_extent(const Json& gltf) {
    return Extents(gltf).first_fault();
}

} // namespace ovc
