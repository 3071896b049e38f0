// SPDX-License-Identifier: Apache-2.0
// Trees in a square grid, whose crowns are leaves in a thick shell. Both kinds of leaves have the
// same outline, so that their pictures may be compared.
#include "testscenes/plants/leaf_canopy.h"

#include "testscenes/corners.h"
#include "testscenes/random.h"
#include "testscenes/scenes.h"

#include <cmath>
#include <iterator>

namespace ovc {

namespace {

constexpr uint32_t kLeavesATree = 4000;
constexpr double kTreesApart = 5.5, kCrownHeight = 5, kCrownRadius = 2.6;
constexpr double kLeafWidth = 0.17, kLeafLength = 0.24;

/// Half of the leaf's width from its stalk to its tip, in widths of its quad, in even steps.
constexpr double kHalfWidth[] = {0,    0.17, 0.3,  0.39, 0.45, 0.48, 0.47,
                                 0.43, 0.37, 0.29, 0.2,  0.1,  0};
constexpr int kStrips = int(std::size(kHalfWidth)) - 1;

double half_width(double v) {
    const double at = v * kStrips;
    const int strip = std::min(int(at), kStrips - 1);
    return glm::mix(kHalfWidth[strip], kHalfWidth[strip + 1], at - strip);
}

/// A quad, and the leaf on it: its stalk is in the middle of the side at v = 0.
struct Leaf {
    dvec3 corner, across, along;

    dvec3 at(double u, double v) const { return corner + u * across + v * along; }
};

Leaf make_leaf(dvec3 tree, Random& random) {
    const dvec3 out = random.direction();
    const dvec3 stalk = tree + kCrownRadius * random.uniform(0.5, 1) * out;
    const dvec3 along = glm::normalize(out + 0.9 * random.in_ball() - dvec3(0, 0.4, 0));
    const dvec3 across =
        glm::normalize(glm::cross(along, any_perpendicular(along) + 0.9 * random.in_ball()));
    const double size = random.uniform(0.75, 1.25);
    return {stalk - 0.5 * size * kLeafWidth * across, size * kLeafWidth * across,
            size * kLeafLength * along};
}

void add_cut_out(const Leaf& leaf, Corners& out, std::vector<vec2>& uv) {
    constexpr vec2 a(0, 0), b(1, 0), c(1, 1), d(0, 1);
    add_quad(out, leaf.at(0, 0), leaf.at(1, 0), leaf.at(1, 1), leaf.at(0, 1));
    uv.insert(uv.end(), {a, b, c, a, c, d});
}

void add_modelled(const Leaf& leaf, Corners& out) {
    const auto left = [&](int row) {
        return leaf.at(0.5 - kHalfWidth[row], double(row) / kStrips);
    };
    const auto right = [&](int row) {
        return leaf.at(0.5 + kHalfWidth[row], double(row) / kStrips);
    };
    add_triangle(out, left(0), right(1), left(1));
    for (int row = 1; row + 2 <= kStrips; ++row)
        add_quad(out, left(row), right(row), right(row + 1), left(row + 1));
    add_triangle(out, left(kStrips - 1), right(kStrips - 1), left(kStrips));
}

/// Draws the leaf: a texel is there where its middle is.
Cutout leaf_picture(uint32_t texels) {
    Cutout cutout;
    cutout.width = cutout.height = texels;
    cutout.beyond = Cutout::Beyond::Hole;
    for (uint32_t y = 0; y < texels; ++y)
        for (uint32_t x = 0; x < texels; ++x) {
            const double u = (x + 0.5) / texels, v = 1 - (y + 0.5) / texels;
            cutout.opacity.push_back(std::abs(u - 0.5) < half_width(v) ? 255 : 0);
        }
    return cutout;
}

void add_trunk(dvec3 foot, Corners& out) {
    constexpr double kSine = 0.8660254037844386;
    constexpr dvec2 kRim[] = {{1, 0},  {0.5, kSine},   {-0.5, kSine},
                              {-1, 0}, {-0.5, -kSine}, {0.5, -kSine}};
    const auto at = [&](size_t i, double height, double radius) {
        const dvec2 rim = radius * kRim[i % std::size(kRim)];
        return foot + dvec3(rim.x, height, rim.y);
    };
    for (size_t i = 0; i < std::size(kRim); ++i)
        add_quad(out, at(i, 0, 0.22), at(i, kCrownHeight, 0.08), at(i + 1, kCrownHeight, 0.08),
                 at(i + 1, 0, 0.22));
}

} // namespace

Scene make_leaf_canopy(const LeafCanopy& canopy) {
    const auto side = uint32_t(std::ceil(std::sqrt(double(canopy.leaves) / kLeavesATree)));
    const bool cut_out = canopy.as == LeafCanopy::Leaves::CutOut;
    const double reach = 0.5 * kTreesApart * (side - 1);
    Random random(29);
    Corners leaves, trunks, ground;
    std::vector<vec2> uv;
    for (uint32_t l = 0; l < canopy.leaves; ++l) {
        const uint32_t tree = l / kLeavesATree;
        const dvec3 foot(kTreesApart * (tree % side) - reach, 0,
                         kTreesApart * (tree / side) - reach);
        if (l % kLeavesATree == 0)
            add_trunk(foot, trunks);
        const Leaf leaf = make_leaf(foot + dvec3(0, kCrownHeight, 0), random);
        if (cut_out)
            add_cut_out(leaf, leaves, uv);
        else
            add_modelled(leaf, leaves);
    }
    const double g = reach + 8;
    add_quad(ground, {-g, 0, -g}, {-g, 0, g}, {g, 0, g}, {g, 0, -g});

    Scene scene;
    scene.materials = {{"leaf", vec3(0.3f, 0.52f, 0.14f)},
                       {"bark", vec3(0.32f, 0.24f, 0.17f)},
                       {"ground", vec3(0.5f, 0.42f, 0.3f)}};
    scene.add_mesh("leaves", 0, Chunk::owning(dvec3(0), std::move(leaves)));
    scene.add_mesh("trunks", 1, Chunk::owning(dvec3(0), std::move(trunks)));
    scene.add_mesh("ground", 2, Chunk::owning(dvec3(0), std::move(ground)));
    if (cut_out) {
        scene.cutouts.push_back(leaf_picture(canopy.texels));
        scene.meshes[0].cutout = 0;
        scene.meshes[0].uv = std::move(uv);
    }
    scene.lights.push_back({dvec3(30, 80, 45), vec3(2.8f)});
    scene.camera = Camera{dvec3(0.35 * reach, 1.8, reach + 7), dvec3(0, 4, 0), dvec3(0, 1, 0), 62};
    return scene;
}

Scene make_leaf_canopy() {
    return make_leaf_canopy(LeafCanopy{});
}

Scene make_modelled_leaf_canopy() {
    return make_leaf_canopy({.as = LeafCanopy::Leaves::Modelled});
}

} // namespace ovc
