// SPDX-License-Identifier: Apache-2.0
// Compares path tracing of the Cornell box with radiosity: the box is cut into patches, Lambert's
// formula gives the form factors, and iteration solves the equations. The two share nothing except
// the box.
// Based on: Goral et al. 1984, "Modeling the Interaction of Light between Diffuse Surfaces"; the
// measured box of Cornell University, with the colors and the light of pbrt-v4-scenes/cornell-box.
#include "host/shade/path_tracer.h"

#include "host/camera/camera_rays.h"
#include "host/render/render_batched.h"
#include "importers/importer.h"
#include "tests/real_data.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <vector>

namespace ovc {
namespace {

constexpr double kPi = std::numbers::pi;

/// The corners run counterclockwise seen from the side that light reaches.
struct Face {
    std::array<dvec3, 4> corners;
    dvec3 albedo;
    double emission = 0;
    int cuts = 8; // A side is cut into so many patches.

    dvec3 at(double u, double v) const {
        return (1 - u) * (1 - v) * corners[0] + u * (1 - v) * corners[1] + u * v * corners[2] +
               (1 - u) * v * corners[3];
    }
    dvec3 normal() const {
        return glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    }
};

std::vector<Face> cornell_box() {
    const dvec3 grey(0.73), red(0.65, 0.05, 0.05), green(0.12, 0.45, 0.15);
    std::vector<Face> box{
        {{{{213, 548.7, 227}, {343, 548.7, 227}, {343, 548.7, 332}, {213, 548.7, 332}}},
         grey,
         20,
         4},
        {{{{552.8, 0, 0}, {549.6, 0, 559.2}, {556, 548.8, 559.2}, {556, 548.8, 0}}}, red, 0, 12},
        {{{{0, 0, 559.2}, {0, 0, 0}, {0, 548.8, 0}, {0, 548.8, 559.2}}}, green, 0, 12},
        {{{{552.8, 0, 0}, {0, 0, 0}, {0, 0, 559.2}, {549.6, 0, 559.2}}}, grey, 0, 16},
        {{{{556, 548.8, 0}, {556, 548.8, 559.2}, {0, 548.8, 559.2}, {0, 548.8, 0}}}, grey, 0, 14},
        {{{{549.6, 0, 559.2}, {0, 0, 559.2}, {0, 548.8, 559.2}, {556, 548.8, 559.2}}},
         grey,
         0,
         12}};
    const auto add_block = [&](const std::array<dvec2, 4>& base, double height) {
        const auto at = [&](size_t i, double y) { return dvec3(base[i % 4].x, y, base[i % 4].y); };
        box.push_back({{at(0, height), at(1, height), at(2, height), at(3, height)}, grey, 0, 5});
        for (size_t i = 0; i < 4; ++i)
            box.push_back({{at(i, 0), at(i + 1, 0), at(i + 1, height), at(i, height)}, grey, 0, 5});
    };
    add_block({{{130, 65}, {82, 225}, {240, 272}, {290, 114}}}, 165);
    add_block({{{423, 247}, {265, 296}, {314, 456}, {472, 406}}}, 330);
    // The faces of the room face its middle, and those of a block face outwards.
    const dvec3 middle(278, 274, 280);
    for (size_t i = 0; i < box.size(); ++i) {
        const dvec3 inner = i < 6 ? middle : i < 11 ? dvec3(186, 80, 169) : dvec3(368, 160, 351);
        const double side = glm::dot(inner - box[i].at(0.5, 0.5), box[i].normal());
        if ((side < 0) == (i < 6))
            std::swap(box[i].corners[1], box[i].corners[3]);
    }
    return box;
}

class PatchRadiosity {
public:
    explicit PatchRadiosity(std::vector<Face> faces) : faces_(std::move(faces)) {
        for (const Face& face : faces_)
            for (int i = 0; i < face.cuts; ++i)
                for (int j = 0; j < face.cuts; ++j)
                    add_patch(face, i, j);
        solve();
    }

    /// Returns the radiance of a matte point.
    dvec3 radiance(const dvec3& at, const dvec3& normal, const dvec3& albedo) const {
        dvec3 sum(0);
        for (const Patch& patch : patches_)
            sum += patch.radiance * form_factor(at, normal, patch);
        return albedo * sum;
    }

private:
    struct Patch {
        std::array<dvec3, 4> corners;
        dvec3 middle, normal, albedo, emission, radiance;
    };

    void add_patch(const Face& face, int i, int j) {
        const double step = 1.0 / face.cuts;
        const double u = i * step, v = j * step;
        const dvec3 emission(face.emission);
        patches_.push_back({{face.at(u, v), face.at(u + step, v), face.at(u + step, v + step),
                             face.at(u, v + step)},
                            face.at(u + 0.5 * step, v + 0.5 * step),
                            face.normal(),
                            face.albedo,
                            emission,
                            emission});
    }

    void solve() {
        const size_t n = patches_.size();
        std::vector<float> factors(n * n);
        for (size_t i = 0; i < n; ++i)
            for (size_t j = 0; j < n; ++j)
                factors[i * n + j] =
                    float(form_factor(patches_[i].middle, patches_[i].normal, patches_[j]));
        for (int round = 0; round < 40; ++round)
            for (size_t i = 0; i < n; ++i) {
                dvec3 sum(0);
                for (size_t j = 0; j < n; ++j)
                    sum += double(factors[i * n + j]) * patches_[j].radiance;
                patches_[i].radiance = patches_[i].emission + patches_[i].albedo * sum;
            }
    }

    /// Applies Lambert's formula to the patch's edges as seen from the point, clipped at the
    /// point's horizon, and scales the result by the share of the patch that is in view.
    double form_factor(const dvec3& at, const dvec3& normal, const Patch& patch) const {
        if (!(glm::dot(at - patch.middle, patch.normal) > 1e-6))
            return 0;
        std::vector<dvec3> polygon;
        for (size_t i = 0; i < 4; ++i) {
            const dvec3 a = patch.corners[i] - at, b = patch.corners[(i + 1) % 4] - at;
            const double above_a = glm::dot(a, normal), above_b = glm::dot(b, normal);
            if (above_a >= 0)
                polygon.push_back(a);
            if ((above_a > 0 && above_b < 0) || (above_a < 0 && above_b > 0))
                polygon.push_back(a + above_a / (above_a - above_b) * (b - a));
        }
        double sum = 0;
        for (size_t i = 0; i < polygon.size(); ++i) {
            const dvec3 a = glm::normalize(polygon[i]);
            const dvec3 b = glm::normalize(polygon[(i + 1) % polygon.size()]);
            const dvec3 across = glm::cross(a, b);
            const double sine = glm::length(across);
            if (sine > 1e-12)
                sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(across / sine, normal);
        }
        const double factor = std::abs(sum) / (2 * kPi);
        return factor > 1e-7 ? factor * in_view(at, patch) : 0;
    }

    double in_view(const dvec3& at, const Patch& patch) const {
        constexpr int kSteps = 2;
        int seen = 0;
        for (int i = 0; i < kSteps; ++i)
            for (int j = 0; j < kSteps; ++j) {
                const double u = (i + 0.5) / kSteps, v = (j + 0.5) / kSteps;
                const dvec3 to = (1 - u) * (1 - v) * patch.corners[0] +
                                 u * (1 - v) * patch.corners[1] + u * v * patch.corners[2] +
                                 (1 - u) * v * patch.corners[3];
                seen += !blocked(at, to);
            }
        return double(seen) / (kSteps * kSteps);
    }

    /// Tests the blocks alone. Nothing else can be in the way, except the lamp in front of the
    /// ceiling.
    bool blocked(const dvec3& from, const dvec3& to) const {
        for (size_t f = 6; f < faces_.size(); ++f) {
            const Face& face = faces_[f];
            const dvec3 n = face.normal(), dir = to - from;
            const double t = glm::dot(face.corners[0] - from, n) / glm::dot(dir, n);
            if (!(t > 1e-6 && t < 1 - 1e-6))
                continue;
            const dvec3 p = from + t * dir;
            bool inside = true;
            for (size_t i = 0; i < 4; ++i)
                inside &= glm::dot(glm::cross(face.corners[(i + 1) % 4] - face.corners[i],
                                              p - face.corners[i]),
                                   n) >= 0;
            if (inside)
                return true;
        }
        return false;
    }

    std::vector<Face> faces_;
    std::vector<Patch> patches_;
};

Scene scene_of(const std::vector<Face>& faces) {
    Scene scene;
    scene.background = {vec3(0), vec3(0)};
    for (const Face& face : faces) {
        Material material;
        material.optics =
            Optics{.diffuse = vec3(face.albedo), .emission = vec3(float(face.emission))};
        scene.materials.push_back(material);
        const auto& c = face.corners;
        scene.add_mesh("face", uint32_t(scene.materials.size() - 1),
                       Chunk::owning(dvec3(0), {vec3(c[0]), vec3(c[1]), vec3(c[2]), vec3(c[0]),
                                                vec3(c[2]), vec3(c[3])}));
    }
    return scene;
}

/// Returns the mean of pixels that all show one point.
dvec3 path_traced(const Scene& scene, Backend& backend, const dvec3& at, const dvec3& normal) {
    Camera camera;
    camera.eye = at + 5.0 * normal;
    camera.target = at;
    camera.up = {0.3, 0.5, 0.7};
    camera.fov_degrees = 1e-3;
    Film film(32, 32, 64);
    const PathTracer tracer(scene, vec3(0, 1, 0), PathTracerOptions{});
    const Pinhole pinhole(camera, film.width(), film.height());
    const auto done = render_batched({tracer, CameraRays(pinhole, film), Sight(scene), {}, film},
                                     backend, size_t(1) << 16);
    EXPECT_TRUE(done && done->complete);
    const Image image = film.image();
    dvec3 sum(0);
    for (const vec4& pixel : image.pixels)
        sum += dvec3(pixel) / double(image.pixels.size());
    return sum;
}

/// These points are on the red wall, the green wall, the floor, the ceiling, the back and the
/// blocks' tops, as (face, u, v). Two of them are in shadow.
constexpr struct {
    size_t face;
    double u, v;
} kPoints[] = {{1, 0.52, 0.47}, {2, 0.43, 0.31}, {3, 0.22, 0.13}, {3, 0.41, 0.31},
               {4, 0.17, 0.71}, {5, 0.48, 0.62}, {6, 0.53, 0.46}, {11, 0.52, 0.53},
               {1, 0.14, 0.82}, {5, 0.81, 0.13}, {8, 0.47, 0.52}};

void compare(const Scene& scene) {
    const std::vector<Face> faces = cornell_box();
    const PatchRadiosity radiosity(faces);
    const std::unique_ptr<Backend> backend = make_cpu_backend(scene.soup);
    for (const auto& point : kPoints) {
        const Face& face = faces[point.face];
        const dvec3 at = face.at(point.u, point.v);
        const dvec3 expected = radiosity.radiance(at, face.normal(), face.albedo);
        const dvec3 found = path_traced(scene, *backend, at, face.normal());
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found[c], expected[c], 0.02 * expected[c])
                << "face " << point.face << " at " << point.u << ", " << point.v;
    }
}

TEST(CornellBox, HasTheRadianceOfRadiosity) {
    compare(scene_of(cornell_box()));
}

TEST(CornellBox, HasItWhenReadFromItsFileToo) {
    const auto data = real_data();
    if (!data)
        GTEST_SKIP() << kNoRealData;
    const std::filesystem::path file = *data / "pbrt/v4-w3ntao/cornell-box/cornell-box.pbrt";
    const Result<Scene> scene = load(file);
    ASSERT_TRUE(scene) << scene.error().message;
    compare(*scene);
}

} // namespace
} // namespace ovc
