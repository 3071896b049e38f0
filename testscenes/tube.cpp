// SPDX-License-Identifier: Apache-2.0
// The points of a tube, its triangles, and its normals.
#include "testscenes/tube.h"

#include "core/system/parallel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <numeric>

namespace ovc {

namespace {

struct Vertex {
    vec3 at, normal;
};

Vertex middle(const Vertex& a, const Vertex& b, const Vertex& c, const Vertex& d) {
    const dvec3 normal = dvec3(a.normal) + dvec3(b.normal) + dvec3(c.normal) + dvec3(d.normal);
    return {vec3(0.25 * (dvec3(a.at) + dvec3(b.at) + dvec3(c.at) + dvec3(d.at))),
            vec3(glm::dot(normal, normal) > 0 ? glm::normalize(normal) : normal)};
}

/// The points of all rings and the two poles.
class Lattice {
public:
    Lattice(const TubeGrid& grid, const TubeShape& shape)
        : grid_(grid), rings_(size_t(grid.along) * grid.around) {
        parallel_for(grid_.along, 8, [&](size_t first, size_t last) {
            for (size_t ring = first; ring < last; ++ring)
                for (uint32_t j = 0; j < grid_.around; ++j)
                    rings_[ring * grid_.around + j].at =
                        vec3(shape(uint32_t(ring) + 1, double(j) / grid_.around));
        });
        poles_[0].at = vec3(shape(0, 0));
        poles_[1].at = vec3(shape(grid.along + 1, 0));
    }

    /// ring: from 0 to along + 1; j is taken modulo `around`.
    const Vertex& at(size_t ring, size_t j) const {
        if (ring == 0 || ring == grid_.along + size_t(1))
            return poles_[ring != 0];
        return rings_[(ring - 1) * grid_.around + j % grid_.around];
    }

    void find_normals() {
        parallel_for(grid_.along, 8, [&](size_t first, size_t last) {
            for (size_t ring = first; ring < last; ++ring)
                for (size_t j = 0; j < grid_.around; ++j) {
                    const dvec3 onwards = step(ring + 2, j, ring, j);
                    const dvec3 round = step(ring + 1, j + 1, ring + 1, j + grid_.around - 1);
                    rings_[ring * grid_.around + j].normal = unit(glm::cross(round, onwards));
                }
        });
        poles_[0].normal = unit(-round_of(1));
        poles_[1].normal = unit(round_of(grid_.along));
    }

private:
    dvec3 step(size_t to_ring, size_t to, size_t from_ring, size_t from) const {
        return dvec3(at(to_ring, to).at) - dvec3(at(from_ring, from).at);
    }
    /// Twice the area that a ring encloses, as a vector along the tube.
    dvec3 round_of(size_t ring) const {
        dvec3 sum(0);
        for (size_t j = 1; j + 1 < grid_.around; ++j)
            sum += glm::cross(step(ring, j, ring, 0), step(ring, j + 1, ring, 0));
        return sum;
    }
    static vec3 unit(const dvec3& v) {
        return glm::dot(v, v) > 0 ? vec3(glm::normalize(v)) : vec3(0, 1, 0);
    }

    const TubeGrid grid_;
    std::vector<Vertex> rings_;
    Vertex poles_[2];
};

/// Writes triangles from a place on, with normals where there is room for them.
class Writer {
public:
    Writer(Surface& out, size_t triangle, bool with_normals)
        : corner_(out.corners.data() + 3 * triangle),
          normal_(with_normals ? out.normals.data() + 3 * triangle : nullptr) {}

    void triangle(const Vertex& a, const Vertex& b, const Vertex& c) {
        for (const Vertex* v : {&a, &b, &c}) {
            *corner_++ = v->at;
            if (normal_)
                *normal_++ = v->normal;
        }
    }

    void quad(const Vertex& a, const Vertex& b, const Vertex& c, const Vertex& d, bool crossed) {
        if (crossed) {
            const Vertex m = middle(a, b, c, d);
            triangle(a, b, m);
            triangle(b, c, m);
            triangle(c, d, m);
            triangle(d, a, m);
        } else {
            triangle(a, b, c);
            triangle(a, c, d);
        }
    }

private:
    vec3* corner_;
    vec3* normal_;
};

} // namespace

TubeGrid tube_grid(uint64_t triangles, double rings_per_point) {
    assert(triangles % 2 == 0 && triangles >= kMinTubeTriangles);
    const uint64_t points = triangles / 2;
    const auto around = uint64_t(std::sqrt(double(points) / rings_per_point) + 0.5);
    TubeGrid grid;
    grid.around = uint32_t(std::clamp<uint64_t>(around, 3, points / 2));
    grid.along = uint32_t(points / grid.around);
    grid.crossed = points - uint64_t(grid.around) * grid.along;
    return grid;
}

void add_tube(Surface& out, const TubeGrid& grid, bool with_normals, const TubeShape& shape) {
    Lattice lattice(grid, shape);
    if (with_normals)
        lattice.find_normals();
    const size_t before = out.corners.size() / 3, around = grid.around;
    out.corners.resize(3 * (before + grid.triangles()));
    if (with_normals)
        out.normals.resize(out.corners.size());
    Writer start(out, before, with_normals);
    for (size_t j = 0; j < around; ++j)
        start.triangle(lattice.at(0, 0), lattice.at(1, j + 1), lattice.at(1, j));
    const size_t first_quad = before + around;
    parallel_for(grid.along - 1, 8, [&](size_t first, size_t last) {
        for (size_t band = first; band < last; ++band) {
            const size_t quad = band * around;
            Writer writer(out, first_quad + 2 * (quad + std::min<size_t>(grid.crossed, quad)),
                          with_normals);
            for (size_t j = 0; j < around; ++j)
                writer.quad(lattice.at(band + 1, j), lattice.at(band + 1, j + 1),
                            lattice.at(band + 2, j + 1), lattice.at(band + 2, j),
                            quad + j < grid.crossed);
        }
    });
    Writer end(out, before + grid.triangles() - around, with_normals);
    for (size_t j = 0; j < around; ++j)
        end.triangle(lattice.at(grid.along + 1, 0), lattice.at(grid.along, j),
                     lattice.at(grid.along, j + 1));
}

std::vector<vec3> smooth_normals(const Corners& corners) {
    // By bits, which order NaN too; + 0 makes one of the two zeros.
    const auto key = [&](uint32_t i) {
        const vec3 p = corners[i] + vec3(0);
        return std::array{std::bit_cast<uint32_t>(p.x), std::bit_cast<uint32_t>(p.y),
                          std::bit_cast<uint32_t>(p.z), i / 3};
    };
    const auto same_place = [&](uint32_t a, uint32_t b) {
        const auto p = key(a), q = key(b);
        return std::equal(p.begin(), p.begin() + 3, q.begin());
    };
    std::vector<uint32_t> order(corners.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
    std::vector<vec3> normals(corners.size());
    for (size_t first = 0, last = 0; first < order.size(); first = last) {
        dvec3 sum(0);
        for (; last < order.size() && same_place(order[first], order[last]); ++last) {
            const vec3* t = &corners[order[last] / 3 * 3];
            sum += glm::cross(dvec3(t[1]) - dvec3(t[0]), dvec3(t[2]) - dvec3(t[0]));
        }
        const vec3 normal = glm::dot(sum, sum) > 0 ? vec3(glm::normalize(sum)) : vec3(0, 1, 0);
        for (size_t i = first; i < last; ++i)
            normals[order[i]] = normal;
    }
    return normals;
}

} // namespace ovc
