// SPDX-License-Identifier: Apache-2.0
// The surface of an area light is halved until there are as many parts as points.
#include "importers/pbrt/look/area_lights.h"

#include <algorithm>
#include <cassert>
#include <numbers>

namespace ovc::pbrt {

namespace {

/// The height of a spot above its surface, in square roots of the surface's area. In the surface,
/// the spot would light it.
constexpr double kHeight = 1e-4;

/// A triangle's middle and area.
struct Patch {
    dvec3 middle;
    dvec3 area_normal; // its length is the area
};

struct Part {
    size_t first, last;
};

void add_patches(const dvec3& a, const dvec3& b, const dvec3& c, int halvings,
                 std::vector<Patch>& patches) {
    if (halvings > 0) {
        const dvec3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
        add_patches(a, ab, ca, halvings - 1, patches);
        add_patches(ab, b, bc, halvings - 1, patches);
        add_patches(ca, bc, c, halvings - 1, patches);
        add_patches(ab, bc, ca, halvings - 1, patches);
        return;
    }
    const Patch patch{(a + b + c) / 3.0, 0.5 * glm::cross(b - a, c - a)};
    if (ovc::is_finite(patch.middle) && ovc::is_finite(patch.area_normal))
        patches.push_back(patch);
}

std::vector<Patch> patches_of(const Shape& shape) {
    std::vector<Patch> patches;
    const Mesh& mesh = shape.mesh;
    const bool mirrored = swaps_handedness(shape.to_object);
    const int halvings = mesh.size() <= 64 ? 1 : 0;
    for (size_t t = 0; t < mesh.size(); ++t) {
        const auto at = [&](size_t i) {
            return point_through(shape.to_object, mesh.corner(3 * t + i));
        };
        const bool turned = is_flipped(shape, t) != mirrored;
        add_patches(at(0), at(turned ? 2 : 1), at(turned ? 1 : 2), halvings, patches);
    }
    return patches;
}

/// Halves the part at the median along the longest side of its bounds, until there is one part per
/// point.
void split(std::vector<Patch>& patches, Part part, size_t points, std::vector<Part>& parts) {
    assert(part.first <= part.last && part.last <= patches.size());
    if (points < 2 || part.last - part.first < 2) {
        parts.push_back(part);
        return;
    }
    Box box;
    for (size_t i = part.first; i < part.last; ++i)
        box.add(patches[i].middle);
    const int axis = major_axis(box.extent());
    const size_t half = part.first + (part.last - part.first) / 2;
    std::nth_element(patches.begin() + long(part.first), patches.begin() + long(half),
                     patches.begin() + long(part.last), [&](const Patch& a, const Patch& b) {
                         return a.middle[axis] < b.middle[axis];
                     });
    split(patches, {part.first, half}, points / 2, parts);
    split(patches, {half, part.last}, points / 2, parts);
}

struct Surface {
    double area = 0;
    dvec3 middle{0};
    dvec3 area_normal{0};
};

Surface surface_of(const std::vector<Patch>& patches, Part part) {
    Surface s;
    for (size_t i = part.first; i < part.last; ++i) {
        const double area = glm::length(patches[i].area_normal);
        s.area += area;
        s.middle += area * patches[i].middle;
        s.area_normal += patches[i].area_normal;
    }
    s.middle = s.area > 0 ? s.middle / s.area : s.middle;
    return s;
}

/// Returns a spot that shines from one side, by the cosine to its normal.
Light lambert_spot(const Surface& s, const dvec3& normal, const vec3& intensity) {
    Light light;
    light.position = s.middle + kHeight * std::sqrt(s.area) * normal;
    light.direction = normal;
    light.cone = SpotCone{1e-3, 0, 1};
    set_falloff(light, intensity);
    return light;
}

} // namespace

void set_falloff(Light& light, const vec3& intensity) {
    constexpr double kNear = 1e-4;
    light.fade_distance = kNear;
    light.fade_power = 2;
    light.color = intensity * float(1 / (2 * kNear * kNear));
}

double surface_area(const Shape& shape) {
    const std::vector<Patch> patches = patches_of(shape);
    return surface_of(patches, {0, patches.size()}).area;
}

std::vector<Light> lights_on(const Shape& shape, const vec3& radiance, bool two_sided) {
    std::vector<Patch> patches = patches_of(shape);
    std::vector<Light> lights;
    const Surface whole = surface_of(patches, {0, patches.size()});
    if (!(whole.area > 0) || !(whole.area < 1e30))
        return lights;
    const double flatness = std::min(glm::length(whole.area_normal) / whole.area, 1.0);
    if (flatness < 0.99) {
        // A convex body is seen, on average, with a quarter of its area (Cauchy).
        Light light;
        light.position = whole.middle;
        set_falloff(light, radiance * float((1 - flatness) * whole.area / 4));
        lights.push_back(light);
    }
    if (flatness <= 0.01)
        return lights;
    std::vector<Part> parts;
    split(patches, {0, patches.size()}, flatness >= 0.99 ? kAreaPoints : 1, parts);
    for (const Part& part : parts) {
        const Surface s = surface_of(patches, part);
        const double length = glm::length(s.area_normal);
        if (!(length > 0))
            continue;
        const dvec3 normal = s.area_normal / length;
        lights.push_back(lambert_spot(s, normal, radiance * float(length)));
        if (two_sided)
            lights.push_back(lambert_spot(s, -normal, radiance * float(length)));
    }
    return lights;
}

} // namespace ovc::pbrt
