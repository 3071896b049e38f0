// SPDX-License-Identifier: Apache-2.0
// Cuts edges where they cross, turns each piece so that the inside is to its left, and follows the
// pieces around: at a point where several meet, always along the same part of the inside.
#include "importers/pov/shapes/simple_contours.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

namespace ovc::pov {
namespace {

struct Edge {
    dvec2 from, to;

    dvec2 at(double s) const { return from + s * (to - from); }
    bool ends_at(const dvec2& p) const { return p == from || p == to; }
};

struct LessByPlace {
    bool operator()(const dvec2& a, const dvec2& b) const {
        return a.x != b.x ? a.x < b.x : a.y < b.y;
    }
};

double cross(const dvec2& a, const dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

/// Returns the point where the edges cross or touch, which is an end where one is as good as there;
/// none for parallel edges.
std::optional<dvec2> common_point(const Edge& e, const Edge& f) {
    constexpr double kAtEnd = 1e-12; // of an edge's length
    const dvec2 along = e.to - e.from, other = f.to - f.from, between = f.from - e.from;
    const double area = cross(along, other);
    const double s = cross(between, other) / area, t = cross(between, along) / area;
    if (!(s >= -kAtEnd && s <= 1 + kAtEnd && t >= -kAtEnd && t <= 1 + kAtEnd))
        return std::nullopt;
    for (const auto& [place, edge] : {std::pair(s, e), std::pair(t, f)})
        if (place < kAtEnd || place > 1 - kAtEnd)
            return place < kAtEnd ? edge.from : edge.to;
    return e.at(s);
}

bool boxes_meet(const Edge& e, const Edge& f) {
    for (int axis = 0; axis < 2; ++axis)
        if (std::max(e.from[axis], e.to[axis]) < std::min(f.from[axis], f.to[axis]) ||
            std::max(f.from[axis], f.to[axis]) < std::min(e.from[axis], e.to[axis]))
            return false;
    return true;
}

std::vector<Edge> edges_of(const std::vector<Contour>& contours) {
    std::vector<Edge> edges;
    for (const Contour& c : contours)
        for (size_t i = 0; i < c.size(); ++i)
            if (const dvec2& next = c[(i + 1) % c.size()]; c[i] != next)
                edges.push_back({c[i], next});
    return edges;
}

/// Returns the pieces of the edges between the points where they cross; none where they do not.
std::vector<Edge> pieces_of(const std::vector<Edge>& edges) {
    std::vector<std::vector<dvec2>> cuts(edges.size());
    bool cross_anywhere = false;
    for (size_t i = 0; i < edges.size(); ++i)
        for (size_t j = i + 1; j < edges.size(); ++j) {
            if (!boxes_meet(edges[i], edges[j]))
                continue;
            const std::optional<dvec2> point = common_point(edges[i], edges[j]);
            for (const size_t k : {i, j})
                if (point && !edges[k].ends_at(*point)) {
                    cuts[k].push_back(*point);
                    cross_anywhere = true;
                }
        }
    std::vector<Edge> pieces;
    for (size_t i = 0; cross_anywhere && i < edges.size(); ++i) {
        const dvec2 along = edges[i].to - edges[i].from;
        std::ranges::sort(cuts[i], {}, [&](const dvec2& p) { return glm::dot(p, along); });
        dvec2 from = edges[i].from;
        cuts[i].push_back(edges[i].to);
        for (const dvec2& to : cuts[i])
            if (from != to)
                pieces.push_back({std::exchange(from, to), to});
    }
    return pieces;
}

/// Removes pieces that lie on each other, two by two: on both sides of them is the same.
void cancel(std::vector<Edge>& pieces) {
    using Ends = std::pair<dvec2, dvec2>;
    const auto less = [](const Ends& a, const Ends& b) {
        return a.first != b.first ? LessByPlace()(a.first, b.first)
                                  : LessByPlace()(a.second, b.second);
    };
    std::map<Ends, Edge, decltype(less)> odd(less);
    for (const Edge& piece : pieces) {
        const Ends ends = std::minmax(piece.from, piece.to, LessByPlace());
        if (odd.erase(ends) == 0)
            odd.emplace(ends, piece);
    }
    pieces.clear();
    for (const auto& [ends, piece] : odd)
        pieces.push_back(piece);
}

/// Returns whether the inside is to the left of the piece with this number.
bool is_left_inside(const std::vector<Edge>& pieces, size_t number) {
    const dvec2 middle = pieces[number].at(0.5), along = pieces[number].to - pieces[number].from;
    // The pieces that a ray from the middle crosses tell what lies on the side where it leaves.
    const int y = std::abs(along.y) >= std::abs(along.x) ? 1 : 0, x = 1 - y;
    bool inside = false;
    for (size_t i = 0; i < pieces.size(); ++i) {
        const auto& [from, to] = pieces[i];
        if (i != number && (from[y] > middle[y]) != (to[y] > middle[y]))
            inside ^=
                middle[x] < from[x] + (to[x] - from[x]) * (middle[y] - from[y]) / (to[y] - from[y]);
    }
    const bool leaves_left = (along[y] < 0) == (y == 1);
    return inside == leaves_left;
}

/// The pieces by the points where they begin.
class Ways {
public:
    explicit Ways(const std::vector<Edge>& pieces) {
        for (size_t i = 0; i < pieces.size(); ++i) {
            const auto& [from, to] = pieces[i];
            if (is_left_inside(pieces, i))
                begins_[from].push_back(to);
            else
                begins_[to].push_back(from);
        }
    }

    /// Takes a contour out; it is empty where there is none any more.
    Contour take() {
        Contour contour;
        if (begins_.empty())
            return contour;
        contour.push_back(begins_.begin()->first);
        contour.push_back(take_next(contour[0], std::nullopt));
        while (contour.back() != contour[0] && begins_.contains(contour.back()))
            contour.push_back(take_next(contour.back(), contour[contour.size() - 2]));
        contour.pop_back(); // the first again
        return contour;
    }

private:
    /// Takes the piece from here on that one from `before` goes on with, and returns where it ends:
    /// the first piece clockwise from there, for between the two is the inside.
    dvec2 take_next(const dvec2& here, const std::optional<dvec2>& before) {
        const auto from_here = begins_.find(here);
        std::vector<dvec2>& ends = from_here->second;
        const auto turn = [&](const dvec2& end) {
            const dvec2 back = before.value_or(ends[0]) - here, ahead = end - here;
            const double angle = std::atan2(cross(ahead, back), glm::dot(ahead, back));
            return angle > 0 ? angle : angle + 2 * std::numbers::pi;
        };
        const auto next = std::ranges::min_element(ends, {}, turn);
        const dvec2 end = *next;
        ends.erase(next);
        if (ends.empty())
            begins_.erase(from_here);
        return end;
    }

    std::map<dvec2, std::vector<dvec2>, LessByPlace> begins_;
};

} // namespace

std::vector<Contour> simple_contours(std::vector<Contour> contours) {
    std::vector<Edge> pieces = pieces_of(edges_of(contours));
    if (pieces.empty())
        return contours;
    cancel(pieces);
    Ways ways(pieces);
    std::vector<Contour> simple;
    for (Contour contour = ways.take(); !contour.empty(); contour = ways.take())
        if (contour.size() >= 3)
            simple.push_back(std::move(contour));
    return simple;
}

} // namespace ovc::pov
