// SPDX-License-Identifier: Apache-2.0
// pov_mask SCENE WIDTH HEIGHT writes a byte for each pixel to stdout: 1 if the scene covers the
// pixel's middle, 0 if not, 2 where a bent picture shows nothing. importers/pov/compare.py reads
// it.
#include "host/backend/backend.h"
#include "host/camera/camera.h"
#include "host/render/sight.h"
#include "importers/importer.h"

#include <cstdio>
#include <cstdlib>

using namespace ovc;

int main(int count, char** words) {
    if (count != 4) {
        std::fprintf(stderr, "usage: pov_mask SCENE WIDTH HEIGHT\n");
        return 2;
    }
    const ImageSize size{uint32_t(std::atoi(words[2])), uint32_t(std::atoi(words[3]))};
    ImportOptions options;
    options.size = size;
    options.log = [](LogLevel, const std::string& message) {
        std::fprintf(stderr, "%s\n", message.c_str());
    };
    const Result<Scene> scene = load(words[1], options);
    if (!scene) {
        std::fprintf(stderr, "%s\n", scene.error().message.c_str());
        return 1;
    }
    if (const Result<Done> fine = check_camera(*scene->camera); !fine) {
        std::fprintf(stderr, "%s\n", fine.error().message.c_str());
        return 1;
    }
    const Pinhole pinhole(*scene->camera, size.width, size.height);
    std::vector<Ray> rays;
    for (uint32_t y = 0; y < size.height; ++y)
        for (uint32_t x = 0; x < size.width; ++x)
            rays.push_back(pinhole.ray(x, y));
    std::vector<Hit> hits(rays.size());
    Result<std::unique_ptr<Backend>> backend = make_embree_backend(scene->soup, EmbreeMode::Robust);
    if (!backend)
        backend = make_cpu_backend(scene->soup);
    std::vector<uint32_t> masks;
    Exclusions without;
    without.sieves = Sight(*scene).of_camera(rays.size(), masks);
    if (const Result<Done> done = (*backend)->intersect(rays, without, hits); !done) {
        std::fprintf(stderr, "%s\n", done.error().message.c_str());
        return 1;
    }
    for (size_t i = 0; i < hits.size(); ++i)
        std::putchar(rays[i].dir == dvec3(0) ? 2 : hits[i].is_hit() ? 1 : 0);
    return 0;
}
