// SPDX-License-Identifier: Apache-2.0
// Rounds the tree of the CPU KDT to float32, packs it and traverses it.
#include "host/bench/float_kd_tree.h"

#include "core/system/parallel.h"
#include "core/system/stopwatch.h"

#include <array>
#include <bit>
#include <cassert>
#include <cmath>

namespace ovc {

namespace {

/// A KdNode in 8 bytes.
struct FloatNode {
    uint32_t value; // the split plane's float, or a leaf's first reference
    uint32_t bits;  // low 2 bits: the axis, 3 for a leaf; the rest: the upper child, or the count

    explicit FloatNode(const KdNode& node) {
        if (node.is_leaf()) {
            value = node.first();
            bits = 3 | node.count() << 2;
        } else {
            assert(node.above() < 1u << 30);
            value = std::bit_cast<uint32_t>(float(node.split()));
            bits = uint32_t(node.axis()) | node.above() << 2;
        }
    }
    bool is_leaf() const { return (bits & 3) == 3; }
    int axis() const { return int(bits & 3); }
    float split() const { return std::bit_cast<float>(value); }
    uint32_t rest() const { return bits >> 2; }
};
static_assert(sizeof(FloatNode) == 8);

struct FloatTriangle {
    vec3 corner, edge1, edge2;
    TriangleId id;
};

struct FloatRay {
    vec3 org, dir, inv_dir;
    float t_min, t_max;

    explicit FloatRay(const Ray& r)
        : org(r.org),
          dir(r.dir),
          inv_dir(1.0f / dir),
          t_min(float(r.t_min)),
          t_max(float(r.t_max)) {}
};

class FloatKdTree {
public:
    FloatKdTree(const Soup& soup, const KdTree& tree)
        : nodes_(tree.nodes.begin(), tree.nodes.end()), lo_(tree.bounds.lo), hi_(tree.bounds.hi) {
        std::vector<uint32_t> first_of_mesh;
        for (size_t mesh = 0; mesh < soup.chunks.size(); ++mesh) {
            first_of_mesh.push_back(uint32_t(triangles_.size()));
            const size_t count = soup.chunks[mesh].corners().size() / 3;
            for (size_t prim = 0; prim < count; ++prim)
                add(soup, {uint32_t(mesh), uint32_t(prim)});
        }
        references_.reserve(tree.references.size());
        for (const TriangleId id : tree.references)
            references_.push_back(first_of_mesh[id.mesh] + id.prim);
    }

    /// Returns the nearest hit, or any hit with kAnyHit.
    template <bool kAnyHit>
    Hit trace(const Ray& from, TriangleId skip) const {
        FloatRay ray(from);
        Hit hit;
        float enter = ray.t_min, exit = ray.t_max;
        if (!from.valid() || nodes_.empty() || !clip(ray, enter, exit))
            return hit;
        struct Entry {
            uint32_t node;
            float enter, exit;
        };
        std::array<Entry, 128> stack; // trees of kdtree/build.cpp are at most 96 deep
        int top = 0;
        for (uint32_t node = 0;;) {
            while (!nodes_[node].is_leaf()) {
                const FloatNode n = nodes_[node];
                const float distance = n.split() - ray.org[n.axis()];
                const float t = distance * ray.inv_dir[n.axis()];
                const bool below_first = distance > 0 || (distance == 0 && ray.dir[n.axis()] <= 0);
                const uint32_t near = below_first ? node + 1 : n.rest();
                const uint32_t far = below_first ? n.rest() : node + 1;
                if (t > exit || t <= 0) {
                    node = near;
                } else if (t < enter) {
                    node = far;
                } else {
                    stack[size_t(top++)] = {far, t, exit};
                    node = near;
                    exit = t;
                }
            }
            if (test_leaf(nodes_[node], ray, skip, hit) && kAnyHit)
                return hit;
            if (top == 0)
                return hit;
            const Entry next = stack[size_t(--top)];
            if (next.enter > ray.t_max)
                return hit; // all other cells on the stack begin later still
            node = next.node;
            enter = next.enter;
            exit = next.exit;
        }
    }

private:
    void add(const Soup& soup, TriangleId id) {
        const Triangle t = soup.triangle(id);
        const vec3 a(t[0]), b(t[1]), c(t[2]);
        triangles_.push_back({a, b - a, c - a, id});
    }

    bool clip(const FloatRay& ray, float& enter, float& exit) const {
        for (int axis = 0; axis < 3; ++axis) {
            const float a = (lo_[axis] - ray.org[axis]) * ray.inv_dir[axis];
            const float b = (hi_[axis] - ray.org[axis]) * ray.inv_dir[axis];
            enter = std::fmax(enter, std::fmin(a, b));
            exit = std::fmin(exit, std::fmax(a, b));
        }
        return enter <= exit;
    }

    bool test_leaf(const FloatNode& leaf, FloatRay& ray, TriangleId skip, Hit& hit) const {
        bool found = false;
        for (uint32_t i = 0; i < leaf.rest(); ++i)
            found |= test(triangles_[references_[leaf.value + i]], ray, skip, hit);
        return found;
    }

    static bool test(const FloatTriangle& triangle, FloatRay& ray, TriangleId skip, Hit& hit) {
        const vec3 p = glm::cross(ray.dir, triangle.edge2);
        const float scale = 1 / glm::dot(p, triangle.edge1);
        const vec3 from = ray.org - triangle.corner;
        const float u = glm::dot(from, p) * scale;
        if (!(u >= 0 && u <= 1))
            return false;
        const vec3 q = glm::cross(from, triangle.edge1);
        const float v = glm::dot(ray.dir, q) * scale;
        if (!(v >= 0 && u + v <= 1))
            return false;
        const float t = glm::dot(triangle.edge2, q) * scale;
        if (!(t >= ray.t_min && t < ray.t_max) || triangle.id == skip)
            return false;
        ray.t_max = t;
        hit = {t, u, v, triangle.id};
        return true;
    }

    std::vector<FloatNode> nodes_;
    std::vector<uint32_t> references_;
    std::vector<FloatTriangle> triangles_;
    vec3 lo_, hi_;
};

class FloatKdBackend final : public Backend {
public:
    FloatKdBackend(const Soup& soup, const KdTree& tree) : tree_(soup, tree) {
        statistics_.struct_size = sizeof(statistics_);
        statistics_.triangles = soup.triangle_count();
    }

    Result<Done> intersect(std::span<const Ray> rays, const Exclusions& without,
                           std::span<Hit> hits) override {
        for_each(rays, without.skip, [&](size_t i, TriangleId s) {
            hits[i] = tree_.trace</* kAnyHit= */ false>(rays[i], s);
        });
        statistics_.nearest_rays += rays.size();
        return Done{};
    }
    Result<Done> occluded(std::span<const Ray> rays, const Exclusions& without,
                          std::span<uint8_t> occluded) override {
        for_each(rays, without.skip, [&](size_t i, TriangleId s) {
            occluded[i] = tree_.trace</* kAnyHit= */ true>(rays[i], s).is_hit();
        });
        statistics_.occlusion_rays += rays.size();
        return Done{};
    }
    ovc_statistics statistics() const override { return statistics_; }
    std::string renderer() const override { return "CPU KD-tree in float32, not certified"; }

private:
    template <class Answer>
    void for_each(std::span<const Ray> rays, std::span<const TriangleId> skip,
                  const Answer& answer) {
        const Stopwatch watch;
        parallel_for(rays.size(), 64, [&](size_t first, size_t last) {
            for (size_t i = first; i < last; ++i)
                answer(i, skip.empty() ? TriangleId{} : skip[i]);
        });
        statistics_.seconds_trace += watch.seconds();
    }

    FloatKdTree tree_;
    ovc_statistics statistics_{};
};

} // namespace

std::unique_ptr<Backend> make_float_kd_backend(const Soup& soup, const KdTree& tree) {
    return std::make_unique<FloatKdBackend>(soup, tree);
}

} // namespace ovc
