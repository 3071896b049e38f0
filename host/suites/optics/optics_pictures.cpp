// SPDX-License-Identifier: Apache-2.0
// Renders pictures of glass and compares them with pictures that must look the same.
#include "host/suites/optics/optics_pictures.h"

#include "host/render/render.h"
#include "host/suites/stability/stability_meshes.h"

#include <algorithm>

namespace ovc {

namespace {

constexpr uint32_t kSize = 128; // pixels a side in the short form

/// Returns a scene of 16 x 16 squares in two colors, below `place`.
Scene checked_floor(dvec3 place) {
    Scene scene;
    scene.materials = {{"light", vec3(0.9f), 0}, {"dark", vec3(0.1f, 0.1f, 0.3f), 0}};
    Corners squares[2];
    for (int i = -8; i < 8; ++i)
        for (int j = -8; j < 8; ++j)
            add_quad(squares[(i + j) & 1], {i, -1.5, j}, {i, -1.5, j + 1}, {i + 1, -1.5, j + 1},
                     {i + 1, -1.5, j});
    for (uint32_t color = 0; color < 2; ++color)
        scene.add_mesh("squares", color, Chunk::owning(place, std::move(squares[color])));
    scene.camera = Camera{place + dvec3(0.3, 1.2, 6), place - dvec3(0, 0.4, 0), dvec3(0, 1, 0), 40};
    return scene;
}

void add_ball(Scene& scene, dvec3 place, Material material) {
    Corners corners = icosphere();
    std::vector<vec3> normals;
    for (const vec3& corner : corners)
        normals.push_back(glm::normalize(corner));
    scene.materials.push_back(std::move(material));
    scene.add_mesh("ball", uint32_t(scene.materials.size() - 1),
                   Chunk::owning(place, std::move(corners)), std::move(normals));
}

Result<Image> picture(const Scene& scene, const OpticsOptions& options, const LogSink& log,
                      uint64_t& rays) {
    const Result<std::unique_ptr<Backend>> backend = make_backend(scene.soup, options.backend, log);
    if (!backend)
        return backend.error();
    const uint32_t side = kSize * uint32_t(std::min<uint64_t>(options.times, 8));
    Film film(side, side);
    RenderOptions how;
    how.max_depth = 20;
    const Result<RenderReport> report =
        render_picture(scene, *scene.camera, **backend, how, {}, film);
    if (!report)
        return report.error();
    rays += report->rays.total();
    return film.image();
}

Result<OpticsScore> compare(const Scene& scene, const Scene& reference, double allowed,
                            const OpticsOptions& options, const LogSink& log) {
    OpticsScore score;
    const Result<Image> image = picture(scene, options, log, score.rays);
    if (!image)
        return image.error();
    uint64_t more = 0;
    const Result<Image> expected = picture(reference, options, log, more);
    if (!expected)
        return expected.error();
    for (size_t i = 0; i < image->pixels.size(); ++i) {
        const vec4 off = glm::abs(image->pixels[i] - expected->pixels[i]);
        const double largest = std::max(max_component(vec3(off)), off.w);
        score.wrong += !(largest <= allowed);
        score.error = std::max(score.error, largest);
    }
    return score;
}

} // namespace

Result<OpticsScore> unseen_glass(const OpticsOptions& options, const LogSink& log, double ior) {
    const Scene bare = checked_floor(dvec3(0));
    Scene scene = checked_floor(dvec3(0));
    add_ball(scene, dvec3(0), {"glass", vec3(0), 0, 1, vec3(1), ior});
    return compare(scene, bare, /* allowed= */ 1e-6, options, log);
}

Result<OpticsScore> far_glass(const OpticsOptions& options, const LogSink& log) {
    const auto at = [](dvec3 place) {
        Scene scene = checked_floor(place);
        add_ball(scene, place, {"glass", vec3(0), 0.1f, 0.85f, {0.9f, 1, 0.95f}, 1.5});
        add_ball(scene, place + dvec3(2, 0, -1), {"mirror", vec3(0.2f), 0.8f});
        scene.lights.push_back({place + dvec3(-4, 6, 5), vec3(3)});
        return scene;
    };
    return compare(at({4.5e6, 6e6, 6}), at(dvec3(0)), /* allowed= */ 1e-4, options, log);
}

} // namespace ovc
