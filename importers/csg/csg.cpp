// SPDX-License-Identifier: Apache-2.0
#include "importers/csg/csg.h"

#include "importers/csg/cut.h"
#include "importers/csg/rules.h"
#include "importers/csg/stitch.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>

namespace ovc::csg {

namespace {

/// The operand and triangle that an outline comes from.
struct Kept {
    uint32_t operand, triangle;
};

class Evaluation {
public:
    explicit Evaluation(const Tree& tree) : grid_(tree.operands), rules_(tree) {
        for (uint32_t i = 0; i < tree.operands.size(); ++i)
            meshes_.emplace_back(rules_.has_cutters(i) ? tree.operands[i] : Operand{}, grid_);
    }

    std::vector<Part> run(const Tree& tree) {
        std::vector<Part> parts;
        for (uint32_t i = 0; i < meshes_.size(); ++i)
            if (!rules_.has_cutters(i))
                take_whole(i, tree.operands[i], parts);
            else if (rules_.is_shown(i))
                judge(i);
        for (const Stitched& t : stitch(outlines_)) {
            Part part{kept_[t.outline].operand, kept_[t.outline].triangle, false, {}};
            part.turned = meshes_[part.operand].inverse;
            for (size_t i = 0; i < 3; ++i)
                part.corners[i] = grid_.from_grid(t.corners[i]);
            parts.push_back(part);
        }
        return parts;
    }

private:
    struct Touch {
        uint32_t operand, triangle;
    };

    /// Returns triangles of other operands that may touch this one. Some of them only come near.
    std::vector<Touch> touching(uint32_t operand, uint32_t triangle,
                                const std::vector<uint32_t>& cutters) const {
        const GridTriangle& t = meshes_[operand].triangles[triangle];
        const Plane& plane = meshes_[operand].planes[triangle];
        const auto beside = [](const Plane& p, const GridTriangle& other) {
            const int a = side(p, other[0]), b = side(p, other[1]), c = side(p, other[2]);
            return (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
        };
        std::vector<Touch> found;
        for (const uint32_t other : cutters) {
            const Mesh& mesh = meshes_[other];
            mesh.boxes.visit(box_of(t), [&](uint32_t i) {
                if (!is_null(mesh.planes[i]) && !beside(plane, mesh.triangles[i]) &&
                    !beside(mesh.planes[i], t))
                    found.push_back({other, i});
            });
        }
        // A random order makes the tree of cuts flat where the other operand is round.
        std::sort(found.begin(), found.end(), [](const Touch& a, const Touch& b) {
            const auto mixed = [](const Touch& x) {
                return (x.triangle * 2654435761u) ^ (x.operand * 40503u);
            };
            return std::pair(mixed(a), a.triangle) < std::pair(mixed(b), b.triangle);
        });
        return found;
    }

    static void take_whole(uint32_t number, const Operand& operand, std::vector<Part>& parts) {
        for (uint32_t t = 0; t < operand.triangles.size(); ++t) {
            const auto& [a, b, c] = operand.triangles[t];
            if ((operand.hidden.empty() || !operand.hidden[t]) && is_finite(a) && is_finite(b) &&
                is_finite(c))
                parts.push_back({number,
                                 t,
                                 operand.inverse,
                                 {a, operand.inverse ? c : b, operand.inverse ? b : c}});
        }
    }

    void judge(uint32_t operand) {
        const Mesh& mesh = meshes_[operand];
        std::vector<uint32_t> cutters = rules_.cutters(operand);
        std::erase_if(cutters, [&](uint32_t other) {
            return !meshes_[other].solid ||
                   !meshes_[other].boxes.bounds().touches(mesh.boxes.bounds());
        });
        std::vector<uint32_t> untouched;
        for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            if (is_null(mesh.planes[t]) || (!mesh.hidden.empty() && mesh.hidden[t]))
                continue;
            const std::vector<Touch> others = touching(operand, t, cutters);
            if (others.empty())
                untouched.push_back(t);
            else
                judge_cut(operand, t, others);
        }
        judge_whole(operand, untouched);
    }

    void judge_cut(uint32_t operand, uint32_t triangle, const std::vector<Touch>& others) {
        const Mesh& mesh = meshes_[operand];
        Pool pool;
        CutTriangle cut(mesh.triangles[triangle], mesh.planes[triangle], pool);
        for (const Touch& other : others)
            cut.cut(meshes_[other.operand].triangles[other.triangle],
                    meshes_[other.operand].planes[other.triangle]);
        // Halves stand behind the part that they halve, so the loop meets them first. A part stays
        // in one piece if both halves stay.
        const auto parts = cut.parts();
        std::vector<uint8_t> stays(parts.size());
        for (size_t i = parts.size(); i-- > 0;)
            stays[i] = parts[i].above != 0 ? stays[parts[i].above] && stays[parts[i].below]
                                           : stays_polygon(operand, parts[i].polygon, cut.plane());
        std::vector<size_t> todo{0};
        while (!todo.empty()) {
            const size_t at = todo.back();
            todo.pop_back();
            if (stays[at]) {
                Outline outline;
                for (const Point* point : parts[at].polygon.points)
                    outline.push_back(point->rounded);
                keep(operand, triangle, std::move(outline));
            } else if (parts[at].above != 0)
                todo.insert(todo.end(), {parts[at].above, parts[at].below});
        }
    }

    bool stays_polygon(uint32_t operand, const Polygon& polygon, const Plane& plane) const {
        // A polygon too thin to hold a point of the fine grid is judged by a point beside it.
        Point point;
        for (int attempt = 0; attempt < 4; ++attempt) {
            point = inner_point(polygon, plane, attempt);
            const bool is_inside =
                std::all_of(polygon.edges.begin(), polygon.edges.end(), [&](const Edge& edge) {
                    return side(*edge.plane, point) * (edge.below ? -1 : 1) > 0;
                });
            if (is_inside)
                break;
        }
        return rules_.stays(operand, !meshes_[operand].inverse,
                            [&](uint32_t other) { return sides_of(meshes_[other], point, plane); });
    }

    /// Judges triangles that no other operand touches. Connected ones get the same answer, so they
    /// are judged once.
    void judge_whole(uint32_t operand, const std::vector<uint32_t>& triangles) {
        const Mesh& mesh = meshes_[operand];
        std::vector<uint32_t> group(triangles.size());
        std::iota(group.begin(), group.end(), 0u);
        const auto root = [&](uint32_t i) {
            while (group[i] != i)
                i = group[i] = group[group[i]];
            return i;
        };
        std::map<std::pair<GridPoint, GridPoint>, uint32_t> edges;
        for (uint32_t i = 0; i < triangles.size(); ++i)
            for (size_t k = 0; k < 3; ++k) {
                const GridTriangle& t = mesh.triangles[triangles[i]];
                const auto edge = std::minmax(t[k], t[(k + 1) % 3]);
                const auto [at, is_new] = edges.try_emplace({edge.first, edge.second}, i);
                if (!is_new)
                    group[root(i)] = root(at->second);
            }
        std::vector<std::optional<bool>> answer(triangles.size());
        for (uint32_t i = 0; i < triangles.size(); ++i) {
            const GridTriangle& t = mesh.triangles[triangles[i]];
            std::optional<bool>& stays = answer[root(i)];
            if (!stays) {
                Pool pool;
                const Plane& plane = mesh.planes[triangles[i]];
                const CutTriangle whole(t, plane, pool);
                stays = stays_polygon(operand, whole.parts()[0].polygon, plane);
            }
            if (*stays)
                keep(operand, triangles[i], {rounded(t[0]), rounded(t[1]), rounded(t[2])});
        }
    }

    void keep(uint32_t operand, uint32_t triangle, Outline outline) {
        if (meshes_[operand].inverse)
            std::reverse(outline.begin(), outline.end());
        outlines_.push_back(std::move(outline));
        kept_.push_back({operand, triangle});
    }

    Grid grid_;
    Rules rules_;
    std::vector<Mesh> meshes_;
    std::vector<Outline> outlines_; // the outlines that stay
    std::vector<Kept> kept_;
};

} // namespace

std::vector<Part> evaluate(const Tree& tree) {
    return Evaluation(tree).run(tree);
}

} // namespace ovc::csg
