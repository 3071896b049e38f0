// SPDX-License-Identifier: Apache-2.0
// Tests FLIP against the authors' published program, and for properties of any two pictures.
#include "host/diff/flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>

namespace ovc {
namespace {

constexpr int kFlipWidth = 61, kFlipHeight = 43;

/// Red, green and blue, 0 to 255.
using Codes = std::array<int, 3>;

struct Planes {
    std::array<std::vector<float>, 3> planes;

    explicit Planes(const Codes& all = {0, 0, 0}) {
        for (size_t c = 0; c < 3; ++c)
            planes[c].assign(size_t(kFlipWidth) * kFlipHeight, float(all[c]) / 255);
    }
    void set(int x, int y, const Codes& codes) {
        for (size_t c = 0; c < 3; ++c)
            planes[c][size_t(y * kFlipWidth + x)] = float(codes[c]) / 255;
    }
    SrgbPlanes view() const { return {kFlipWidth, kFlipHeight, planes[0], planes[1], planes[2]}; }
};

Codes pattern(int x, int y) {
    return {(x * 5 + y * 2) % 256, (x * x + 3 * y) % 256, (x * y) % 256};
}

Planes reference() {
    Planes planes;
    for (int y = 0; y < kFlipHeight; ++y)
        for (int x = 0; x < kFlipWidth; ++x)
            planes.set(x, y, pattern(x, y));
    return planes;
}

/// Returns reference() with a red block, a brighter right third and one white pixel.
Planes changed() {
    Planes planes = reference();
    for (int y = 0; y < kFlipHeight; ++y)
        for (int x = 0; x < kFlipWidth; ++x) {
            Codes codes = pattern(x, y);
            if (y >= 10 && y < 20 && x >= 12 && x < 30)
                codes = {200, 40, 10};
            if (x >= 40)
                for (int& code : codes)
                    code = std::min(code + 9, 255);
            planes.set(x, y, codes);
        }
    planes.set(5, 30, {255, 255, 255});
    return planes;
}

double mean(const std::vector<float>& errors) {
    return std::accumulate(errors.begin(), errors.end(), 0.0) / double(errors.size());
}

// The numbers are those of compute_ldrflip() of python/flip_api.py in github.com/NVlabs/flip on
// these pictures, in double precision and with the kernels in two dimensions.
TEST(Flip, IsWhatItsAuthorsCompute) {
    const std::vector<float> errors = flip_errors(reference().view(), changed().view());
    EXPECT_NEAR(mean(errors), 0.149822, 2e-5);
    EXPECT_NEAR(double(*std::max_element(errors.begin(), errors.end())), 0.975576, 2e-5);
    const auto at = [&](int x, int y) { return double(errors[size_t(y * kFlipWidth + x)]); };
    EXPECT_NEAR(at(20, 15), 0.964883, 5e-5);
    EXPECT_NEAR(at(5, 30), 0.411653, 5e-5);
    EXPECT_NEAR(at(45, 0), 0.205866, 5e-5);
    EXPECT_NEAR(at(60, 42), 0.173755, 5e-5);
    EXPECT_NEAR(at(31, 9), 0.056547, 5e-5);
    EXPECT_NEAR(at(5, 12), 0.022405, 5e-5);
}

TEST(Flip, OfPlainPicturesIsWhatItsAuthorsCompute) {
    const auto between = [](const Codes& a, const Codes& b) {
        return mean(flip_errors(Planes(a).view(), Planes(b).view()));
    };
    EXPECT_NEAR(between({0, 0, 0}, {255, 255, 255}), 0.967380, 1e-5);
    EXPECT_NEAR(between({0, 255, 0}, {0, 0, 255}), 1, 1e-5) << "the farthest colors there are";
}

TEST(Flip, IsSymmetricAndZeroForTheSamePicture) {
    const Planes a = reference(), b = changed();
    for (const float error : flip_errors(a.view(), a.view()))
        ASSERT_EQ(error, 0);
    EXPECT_EQ(flip_errors(a.view(), b.view()), flip_errors(b.view(), a.view()));
}

TEST(Flip, OfOnePixelFadesWithTheViewersDistance) {
    const Planes gray({90, 90, 90});
    Planes speck = gray;
    speck.set(30, 20, {160, 90, 90});
    double last = 1;
    for (const double pixels_per_degree : {20.0, 67.0, 200.0}) {
        const double now =
            double(flip_errors(gray.view(), speck.view(), pixels_per_degree)[20 * kFlipWidth + 30]);
        EXPECT_LT(now, 0.7 * last);
        EXPECT_GT(now, 0);
        last = now;
    }
}

} // namespace
} // namespace ovc
