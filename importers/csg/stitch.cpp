// SPDX-License-Identifier: Apache-2.0
#include "importers/csg/stitch.h"

#include "importers/csg/box_tree.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace ovc::csg {

namespace {

struct HashOfCorner {
    size_t operator()(const Corner& p) const {
        uint64_t h = 0;
        for (const int64_t x : p)
            h = (h ^ uint64_t(x)) * 0x9e3779b97f4a7c15u, h ^= h >> 32;
        return h;
    }
};

/// Corners are snapped to 2^-36 of the size of all operands. Because the operands' corners were
/// rounded, lines that should meet in one point meet in several, a little apart. Snapping makes
/// these one point again. Edges that matched still match, whichever corners become one.
constexpr int kSnappedBits = kSnapBits + kFractionBits;

Corner snapped(Corner p) {
    for (int64_t& x : p)
        x = (x + (int64_t(1) << (kSnappedBits - 1))) >> kSnappedBits << kSnappedBits;
    return p;
}

/// A corner and the number of the straight line that starts or goes on at it. Corners in line have
/// the same number.
struct Turn {
    uint32_t vertex;
    uint32_t line;
};
using Loop = std::vector<Turn>;

class Stitcher {
public:
    explicit Stitcher(const std::vector<Outline>& outlines) {
        for (const Outline& outline : outlines) {
            Loop loop;
            for (const Corner& corner : outline)
                loop.push_back({number(corner), uint32_t(loop.size())});
            loops_.push_back(tidied(std::move(loop)));
        }
        find_open();
        insert_corners();
    }

    std::vector<Stitched> triangles() const {
        std::vector<Stitched> all;
        for (uint32_t i = 0; i < loops_.size(); ++i)
            triangulate(i, all);
        return all;
    }

private:
    uint32_t number(const Corner& corner) {
        const Corner place = snapped(corner);
        const auto [at, is_new] = numbers_.try_emplace(place, uint32_t(vertices_.size()));
        if (is_new)
            vertices_.push_back(place);
        return at->second;
    }

    dvec3 place(uint32_t vertex) const {
        const Corner& p = vertices_[vertex];
        return {double(p[0]), double(p[1]), double(p[2])};
    }

    /// Removes edges that rounding has made points.
    static Loop tidied(Loop loop) {
        Loop kept;
        for (size_t i = 0; i < loop.size(); ++i)
            if (loop[i].vertex != loop[(i + 1) % loop.size()].vertex)
                kept.push_back(loop[i]);
        return kept.size() < 3 ? Loop() : kept;
    }

    static uint64_t key(uint32_t a, uint32_t b) { return uint64_t(a) << 32 | b; }

    /// Counts for each edge how often it is run along one way, less the other way. An edge with
    /// another count than 0 is open.
    void find_open() {
        for (const Loop& loop : loops_)
            for (size_t i = 0; i < loop.size(); ++i) {
                const uint32_t a = loop[i].vertex, b = loop[(i + 1) % loop.size()].vertex;
                balance_[a < b ? key(a, b) : key(b, a)] += a < b ? 1 : -1;
            }
    }

    bool is_open(uint32_t a, uint32_t b) const {
        return balance_.at(a < b ? key(a, b) : key(b, a)) != 0;
    }

    void insert_corners() {
        std::vector<uint32_t> ends;
        for (const auto& [edge, balance] : balance_)
            if (balance != 0)
                ends.insert(ends.end(), {uint32_t(edge >> 32), uint32_t(edge)});
        std::sort(ends.begin(), ends.end());
        ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
        std::vector<Box> boxes;
        for (const uint32_t end : ends)
            boxes.push_back({place(end), place(end)});
        const BoxTree tree(boxes);
        for (Loop& loop : loops_) {
            Loop longer;
            for (size_t i = 0; i < loop.size(); ++i) {
                const uint32_t next = loop[(i + 1) % loop.size()].vertex;
                longer.push_back(loop[i]);
                if (is_open(loop[i].vertex, next))
                    for (const uint32_t vertex : between(loop[i].vertex, next, tree, ends))
                        longer.push_back({vertex, loop[i].line});
            }
            loop = std::move(longer);
        }
    }

    /// Returns the ends that lie between a and b, in order. They lie there exactly before they are
    /// snapped. Snapping moves them, a and b by at most half a unit in each coordinate.
    std::vector<uint32_t> between(uint32_t a, uint32_t b, const BoxTree& tree,
                                  const std::vector<uint32_t>& ends) const {
        constexpr double kOff = 2 << kSnappedBits;
        const dvec3 from = place(a), way = place(b) - from;
        const double square = glm::dot(way, way);
        Box box;
        box.add(from);
        box.add(from + way);
        std::vector<std::pair<double, uint32_t>> found;
        tree.visit(box.padded(kOff), [&](uint32_t i) {
            const dvec3 p = place(ends[i]) - from;
            const double along = glm::dot(p, way) / square;
            if (ends[i] != a && ends[i] != b && along > 0 && along < 1 &&
                glm::length(p - along * way) <= kOff)
                found.push_back({along, ends[i]});
        });
        std::sort(found.begin(), found.end());
        std::vector<uint32_t> order;
        for (const auto& [along, vertex] : found)
            order.push_back(vertex);
        return order;
    }

    void add(uint32_t outline, uint32_t a, uint32_t b, uint32_t c,
             std::vector<Stitched>& out) const {
        if (a != b && b != c && c != a)
            out.push_back({outline, {vertices_[a], vertices_[b], vertices_[c]}});
    }

    /// Cuts off one corner after another, the shortest cut first, but no corner whose cut leaves
    /// nothing but a line.
    void triangulate(uint32_t outline, std::vector<Stitched>& out) const {
        Loop loop = loops_[outline];
        uint32_t line = uint32_t(loop.size());
        while (loop.size() > 3) {
            const size_t count = loop.size();
            const auto is_corner = [&](size_t i) {
                return loop[i % count].line != loop[(i + count - 1) % count].line;
            };
            size_t corners = 0;
            for (size_t i = 0; i < count; ++i)
                corners += is_corner(i);
            size_t best = count;
            double shortest = std::numeric_limits<double>::infinity();
            for (size_t i = 0; i < count; ++i) {
                const size_t around = is_corner(i) + is_corner(i + 1) + is_corner(i + count - 1);
                if (!is_corner(i) || corners <= around)
                    continue;
                const dvec3 cut = place(loop[(i + 1) % count].vertex) -
                                  place(loop[(i + count - 1) % count].vertex);
                if (glm::dot(cut, cut) < shortest) {
                    shortest = glm::dot(cut, cut);
                    best = i;
                }
            }
            if (best == count)
                break; // A triangle with corners on one of its edges is left, see below.
            const size_t before = (best + count - 1) % count, after = (best + 1) % count;
            add(outline, loop[before].vertex, loop[best].vertex, loop[after].vertex, out);
            loop[before].line = ++line;
            loop.erase(loop.begin() + ptrdiff_t(best));
        }
        // The apex is the corner that does not lie on the edge with further corners. In a triangle
        // without such an edge, any corner will do.
        const size_t count = loop.size();
        size_t apex = 0;
        for (size_t i = 0; i < count; ++i)
            if (loop[i].line != loop[(i + count - 1) % count].line &&
                loop[(i + count - 1) % count].line != loop[(i + count - 2) % count].line &&
                loop[(i + 1) % count].line != loop[i].line)
                apex = i;
        for (size_t i = 1; i + 1 < count; ++i)
            add(outline, loop[apex].vertex, loop[(apex + i) % count].vertex,
                loop[(apex + i + 1) % count].vertex, out);
    }

    std::vector<Corner> vertices_;
    std::unordered_map<Corner, uint32_t, HashOfCorner> numbers_;
    std::vector<Loop> loops_;
    std::unordered_map<uint64_t, int> balance_;
};

} // namespace

std::vector<Stitched> stitch(const std::vector<Outline>& outlines) {
    return Stitcher(outlines).triangles();
}

} // namespace ovc::csg
