// SPDX-License-Identifier: Apache-2.0
// Tests bent pictures against the directions of povray 3.7.0.10 through pixels of a 160 x 120
// picture. They come from a sphere around its camera whose color tells the direction.
#include "host/camera/bent_window.h"

#include <gtest/gtest.h>

#include <optional>

namespace ovc {
namespace {

using Bend = ImageWindow::Bend;

struct BentCase {
    const char* name;
    Bend bend;
    double right;
    double angle, vertical_angle;
    std::optional<dvec3> seen[3]; // directions through kPixels; none: the pixel is left out
};

constexpr dvec2 kPixels[3] = {{90, 20}, {40, 80}, {120, 100}};

const BentCase kCases[] = {
    {"Fisheye",
     Bend::Fisheye,
     4 / 3.0,
     120,
     60,
     {{{0.1681, 0.6324, 0.7562}}, {{-0.6221, -0.3229, 0.7132}}, {{0.5949, -0.5949, 0.5406}}}},
    {"UltraWide",
     Bend::UltraWide,
     4 / 3.0,
     120,
     60,
     {{{0.1367, 0.4932, 0.8591}}, {{-0.4901, -0.2629, 0.8311}}, {{0.4899, -0.4899, 0.7211}}}},
    {"Omnimax",
     Bend::Omnimax,
     4 / 3.0,
     90,
     60,
     {{{0.1606, 0.8641, 0.477}}, {{-0.6592, -0.0583, 0.7497}}, {{0.6545, -0.3797, 0.6538}}}},
    {"OmnimaxMiddle",
     Bend::Omnimax,
     1.2,
     90,
     60,
     {{{0.1559, 0.8493, 0.5043}}, {{-0.636, -0.1521, 0.7566}}, {{0.622, -0.4863, 0.6137}}}},
    {"OmnimaxNarrow",
     Bend::Omnimax,
     0.8,
     90,
     60,
     {{{0.1482, 0.9289, 0.3393}}, {{-0.6042, -0.5227, 0.6014}}, {}}},
    {"Panoramic",
     Bend::Panoramic,
     4 / 3.0,
     120,
     60,
     {{{0.139, 0.8558, 0.4983}}, {{-0.7087, -0.4517, 0.5421}}, {{0.4446, -0.8339, 0.327}}}},
    {"Spherical",
     Bend::Spherical,
     4 / 3.0,
     180,
     90,
     {{{0.1779, 0.4943, 0.8509}}, {{-0.6751, -0.2652, 0.6885}}, {{0.616, -0.5057, 0.604}}}},
    {"SphericalMirrored",
     Bend::Spherical,
     -4 / 3.0,
     180,
     90,
     {{{0.1779, -0.4943, 0.8509}}, {{-0.6751, 0.2652, 0.6885}}, {{0.616, 0.5057, 0.604}}}},
    {"Cylinder1",
     Bend::Cylinder1,
     4 / 3.0,
     120,
     60,
     {{{0.1302, 0.3127, 0.9409}}, {{-0.4873, -0.1684, 0.8569}}, {{0.4791, -0.3198, 0.8174}}}},
    {"Cylinder2",
     Bend::Cylinder2,
     4 / 3.0,
     120,
     60,
     {{{0.0872, 0.6337, 0.7687}}, {{-0.3127, -0.3327, 0.8897}}, {{0.3198, -0.6154, 0.7205}}}},
    {"Cylinder3",
     Bend::Cylinder3,
     4 / 3.0,
     120,
     60,
     {{{0.137, 0.0003, 0.9906}}, {{-0.4943, -0.0002, 0.8693}}, {{0.5057, -0.0003, 0.8627}}}},
    {"Cylinder4",
     Bend::Cylinder4,
     4 / 3.0,
     120,
     60,
     {{{0.0001, 0.6361, 0.7716}}, {{-0.0003, -0.3502, 0.9367}}, {{0.0003, -0.6494, 0.7604}}}},
};

class BentWindow : public testing::TestWithParam<BentCase> {};

TEST_P(BentWindow, LooksWherePovRayLooks) {
    const BentCase& c = GetParam();
    ImageWindow window;
    window.right = {c.right, 0, 0};
    window.bend = c.bend;
    window.angle = c.angle;
    window.vertical_angle = c.vertical_angle;
    for (size_t i = 0; i < 3; ++i) {
        const dvec2 at = (kPixels[i] + 0.5) / dvec2(160, 120) - 0.5;
        const Ray ray = bent_ray(window, dvec3(0), {at.x, -at.y});
        if (!c.seen[i]) {
            EXPECT_EQ(glm::length(ray.dir), 0) << i;
            continue;
        }
        EXPECT_LT(glm::length(glm::normalize(ray.dir) - *c.seen[i]), 0.001)
            << i << ": " << ray.dir.x << " " << ray.dir.y << " " << ray.dir.z;
    }
}

INSTANTIATE_TEST_SUITE_P(All, BentWindow, testing::ValuesIn(kCases),
                         [](const auto& bent) { return std::string(bent.param.name); });

} // namespace
} // namespace ovc
