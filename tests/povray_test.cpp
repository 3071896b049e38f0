// SPDX-License-Identifier: Apache-2.0
// Tests that glass, mirrors and shadows through glass look as POV-Ray draws them. POV-Ray draws its
// own spheres, Overcast triangles.
#include "host/render/render.h"
#include "importers/importer.h"
#include "tests/run_command.h"
#include "testscenes/catalog.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>

namespace ovc {
namespace {

constexpr uint32_t kSize = 256;

/// Reads a binary PPM with two bytes for each color, which are linear.
std::optional<Image> read_ppm(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::string header, line;
    uint32_t width = 0, height = 0, most = 0;
    while (most == 0 && std::getline(file, line)) {
        // POV-Ray writes a comment that says when and by whom the picture was drawn.
        header += line[0] == '#' ? "" : line + " ";
        std::sscanf(header.c_str(), "P6 %u %u %u", &width, &height, &most);
    }
    if (most != 65535)
        return std::nullopt;
    Image image(width, height);
    for (vec4& pixel : image.pixels) {
        unsigned char bytes[6];
        if (!file.read(reinterpret_cast<char*>(bytes), 6))
            return std::nullopt;
        for (int i = 0; i < 3; ++i)
            pixel[i] = float(256 * bytes[2 * i] + bytes[2 * i + 1]) / 65535;
        pixel.a = 1;
    }
    return image;
}

/// Returns POV-Ray's picture of a scene, with linear colors. If POV-Ray draws none, returns
/// nothing, and the test fails or is skipped.
std::optional<Image> drawn_by_povray(const std::string& scene,
                                     const std::string& antialias = "-A") {
    const std::filesystem::path ppm =
        std::filesystem::temp_directory_path() / fmt::format("ovc-povray-{}.ppm", getpid());
    const test::CommandResult drawn =
        test::run_shell(fmt::format("povray +I{} +O{} +W{} +H{} +FP16 File_Gamma=1.0 {} -D -GA",
                                    scene, ppm.string(), kSize, kSize, antialias));
    EXPECT_EQ(drawn.exit_code, 0) << drawn.output;
    std::optional<Image> image = read_ppm(ppm);
    std::filesystem::remove(ppm);
    EXPECT_TRUE(image && image->width == kSize && image->height == kSize);
    return image;
}

/// mean: a limit on the mean difference over colors and pixels. unlike_share: a limit on the share
/// of pixels that differ by more than 0.02.
void expect_alike(const Scene& scene, uint32_t max_depth, const Image& theirs, double mean,
                  double unlike_share, std::optional<Antialias> antialias = {}) {
    Film film(kSize, kSize);
    RenderOptions options;
    options.antialias = antialias;
    options.max_depth = max_depth;
    const std::unique_ptr<Backend> backend = make_cpu_backend(scene.soup);
    ASSERT_TRUE(render_picture(scene, *scene.camera, *backend, options, {}, film));
    const Image ours = film.image();
    double sum = 0;
    size_t unlike = 0;
    for (size_t i = 0; i < ours.pixels.size(); ++i) {
        // POV-Ray clips colors that are brighter than white.
        const vec3 off = glm::abs(glm::min(vec3(ours.pixels[i]), vec3(1)) - vec3(theirs.pixels[i]));
        sum += double(off.x + off.y + off.z) / 3;
        unlike += max_component(off) > 0.02f;
    }
    std::printf("mean difference %.5f, %zu of %zu pixels unlike\n",
                sum / double(ours.pixels.size()), unlike, ours.pixels.size());
    // Facets and spheres may disagree where an edge of a square or ball crosses a pixel's middle.
    EXPECT_LT(sum / double(ours.pixels.size()), mean);
    EXPECT_LT(double(unlike), unlike_share * double(ours.pixels.size()));
}

bool has_povray() {
    return test::run_shell("command -v povray").exit_code == 0;
}

TEST(Povray, DrawsGlassAndMirrorsAsWeDo) {
    if (!has_povray())
        GTEST_SKIP() << "povray is not installed";
    const std::optional<Image> theirs = drawn_by_povray(OVC_SOURCE_DIR "/testscenes/glass.pov");
    ASSERT_TRUE(theirs);
    const Result<Scene> scene = make_test_scene("glass");
    ASSERT_TRUE(scene);
    expect_alike(*scene, 12, *theirs, 0.001, 1 / 250.0);
}

/// Both programs read the same file.
void expect_file_alike(const std::string& name, double mean, double unlike_share) {
    if (!has_povray())
        GTEST_SKIP() << "povray is not installed";
    const std::string file = OVC_SOURCE_DIR "/testscenes/" + name;
    const std::optional<Image> theirs = drawn_by_povray(file);
    ASSERT_TRUE(theirs);
    ImportOptions options;
    options.size = ImageSize{kSize, kSize};
    const Result<Scene> scene = load(file, options);
    ASSERT_TRUE(scene) << scene.error().message;
    expect_alike(*scene, scene->max_depth.value_or(5), *theirs, mean, unlike_share);
}

/// Both programs read the same scene of a few lines.
void expect_text_alike(const std::string& text, double mean, double unlike_share,
                       std::optional<Antialias> antialias = {},
                       const std::string& in_povray = "-A") {
    if (!has_povray())
        GTEST_SKIP() << "povray is not installed";
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / fmt::format("ovc-povray-{}.pov", getpid());
    std::ofstream(file) << text;
    const std::optional<Image> theirs = drawn_by_povray(file.string(), in_povray);
    ImportOptions options;
    options.size = ImageSize{kSize, kSize};
    const Result<Scene> scene = load(file, options);
    std::filesystem::remove(file);
    ASSERT_TRUE(theirs);
    ASSERT_TRUE(scene) << scene.error().message;
    expect_alike(*scene, scene->max_depth.value_or(5), *theirs, mean, unlike_share, antialias);
}

const std::string kPlaneAndBall =
    "#version 3.7; global_settings { assumed_gamma 1 }\n"
    "camera { location <0, 2, -6> right x up y look_at <0, 1, 0> }\n"
    "light_source { <5, 8, -5> rgb 1 }\n"
    "plane { y, 0 pigment { rgb <0.3, 0.5, 0.3> } }\n"
    "sphere { <0, 1, 0>, 1 pigment { rgb <1, 0.2, 0.1> } finish { phong 0.7 } }\n";

TEST(Povray, SmoothsEdgesAsWeDo) {
    expect_text_alike(kPlaneAndBall, 0.0006, 1 / 100.0, Antialias{.jitter = 0}, "+A -J");
    expect_text_alike(kPlaneAndBall, 0.0006, 1 / 100.0,
                      Antialias{.method = Antialias::Method::Subdivide, .jitter = 0}, "+A +AM2 -J");
    expect_text_alike(kPlaneAndBall, 0.0006, 1 / 100.0, Antialias{}, "+A");
}

TEST(Povray, DrawsOldScenesAndDarkOnesAsWeDo) {
    const std::string view = "camera { location <0, 0, -5> right x up y look_at 0 }\n";
    expect_text_alike("#version 3.7; global_settings { assumed_gamma 1 }\n" + view +
                          "#declare P = pigment { rgb <1, 0.5, 0> }; sphere { 0, 1 texture { P } "
                          "finish { ambient 0.4 emission 0.2 } }",
                      0.002, 1 / 100.0);
    expect_text_alike("#version 3.1\n" + view +
                          "light_source { <5, 5, -5> rgb 1 }\n#declare X = -1\n#while (X < 2)\n"
                          "sphere { <X, 0, 0>, 0.6 pigment { rgbf <1, 0.9, 0.9, 0.9> } finish { "
                          "ior 1.3 refraction 1 } }\n#declare X = X + 1\n#end\n"
                          "plane { -z, -2 pigment { checker rgb 1 rgb 0.2 scale 0.7 } finish { "
                          "ambient 0.6 } }",
                      0.004, 1 / 40.0);
}

TEST(Povray, DrawsLightsAndFinishesAsWeDoFromTheSameFile) {
    // The far squares of the floor are smaller than a pixel.
    expect_file_alike("lights.pov", 0.003, 1 / 60.0);
}

TEST(Povray, DrawsSolidsAsWeDo) {
    expect_file_alike("solids.pov", 0.002, 1 / 100.0);
}

TEST(Povray, DrawsImplicitSurfacesAsWeDo) {
    expect_file_alike("fields.pov", 0.002, 1 / 100.0);
}

} // namespace
} // namespace ovc
