// SPDX-License-Identifier: Apache-2.0
// Adaptive antialiasing: the colors that povray 3.7.0.10 makes with -J, and how many samples.
#include "host/render/antialias.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

using Method = Antialias::Method;

/// Samples a function that gives the color at each point.
template <class Color>
class FunctionTracer : public SampleTracer {
public:
    explicit FunctionTracer(Color color) : color_(color) {}

    bool trace_middles(Film& film) override {
        for (uint32_t y = 0, i = 0; y < film.height(); ++y)
            for (uint32_t x = 0; x < film.width(); ++x, ++i) {
                film.add(i, color_(dvec2(x, y) + 0.5));
                film.close(i);
            }
        return count(film.pixels_done());
    }

    bool trace_points(std::span<const dvec2> points, std::span<vec3> light) override {
        const size_t each = points.size() / light.size();
        EXPECT_EQ(light.size() * each, points.size());
        for (size_t i = 0; i < light.size(); ++i) {
            light[i] = vec3(0);
            for (const dvec2& point : points.subspan(i * each, each))
                light[i] += color_(point) / float(each);
        }
        return count(points.size());
    }

    size_t samples = 0;
    size_t calls = 0;
    size_t max_calls = SIZE_MAX;

private:
    bool count(size_t more) {
        samples += more;
        return ++calls < max_calls;
    }

    const Color color_;
};

struct Traced {
    std::vector<vec4> colors;
    size_t samples = 0;
    size_t calls = 0;
};

/// Returns the picture of the function.
template <class Color>
Traced traced(const ImageSize& size, const Antialias& how, Color color, double gamma = 1) {
    FunctionTracer tracer(color);
    Film film(size.width, size.height);
    EXPECT_TRUE(antialias(how, gamma, tracer, film));
    EXPECT_EQ(film.pixels_done(), uint64_t(size.width) * size.height);
    return {film.image().pixels, tracer.samples, tracer.calls};
}

constexpr ImageSize kSize{8, 6};
constexpr double kLeft = 4.4; // where the white half begins; the rest is black
vec3 half_white(const dvec2& at) {
    return vec3(at.x > kLeft ? 1.0f : 0.0f);
}

TEST(Antialias, EdgesAreAsPovrayDrawsThem) {
    const struct {
        Method method;
        uint32_t depth;
        float edge;
    } cases[] = {{Method::Supersample, 1, 1},
                 {Method::Supersample, 2, 0.6f},
                 {Method::Supersample, 3, 0.7f},
                 {Method::Subdivide, 1, 0.5f},
                 {Method::Subdivide, 3, 0.625f}};
    for (const auto& c : cases) {
        const Traced picture = traced(kSize, {c.method, 0.3f, c.depth, 0}, half_white);
        for (size_t i = 0; i < picture.colors.size(); ++i) {
            const size_t x = i % kSize.width;
            const float expected = x < 4 ? 0 : x > 4 ? 1 : c.edge;
            EXPECT_NEAR(picture.colors[i].x, expected, 1e-6)
                << "method " << int(c.method) << ", depth " << c.depth << ", column " << x;
        }
    }
}

TEST(Antialias, FlatPicturesTakeOneSampleAPixel) {
    const ImageSize size{100, 50};
    const auto gray = [](const dvec2&) { return vec3(0.4f); };
    EXPECT_EQ(traced(size, {}, gray).samples, 100 * 50u);
    EXPECT_EQ(traced(size, {.method = Method::Subdivide}, gray).samples, 101 * 51u);
    // A gradient below the threshold counts as flat.
    const auto sky = [](const dvec2& at) { return vec3(float(0.2 + at.y / 100)); };
    EXPECT_EQ(traced(size, {}, sky).samples, 100 * 50u);
}

TEST(Antialias, SamplesAreWhereColorsDiffer) {
    // povray takes 162 more here: two columns, and a third that differs from the mean.
    EXPECT_EQ(traced(kSize, {.jitter = 0}, half_white).samples, 8 * 6 + 162u);
    EXPECT_EQ(traced(kSize, {.threshold = 0}, half_white).samples, 8 * 6 * 10u) << "all of them";
    EXPECT_EQ(traced(kSize, {.threshold = 3}, half_white).samples, 8 * 6 + 108u)
        << "black and white differ by 3";
    const auto dark = [](const dvec2& at) { return 0.02f * half_white(at); };
    EXPECT_GT(traced(kSize, {}, dark).samples, 48u) << "as eyes see it";
    EXPECT_EQ(traced(kSize, {}, dark, 2.2).samples, 48u) << "what is for a screen already";
}

TEST(Antialias, JitterStaysInItsPixelAndIsTheSameEveryTime) {
    for (const Method method : {Method::Supersample, Method::Subdivide}) {
        std::vector<dvec2> seen[2];
        for (std::vector<dvec2>& points : seen)
            traced(kSize, {.method = method, .threshold = 0}, [&](const dvec2& at) {
                points.push_back(at);
                EXPECT_TRUE(at.x >= 0 && at.y >= 0 && at.x <= 8 && at.y <= 6);
                return half_white(at);
            });
        EXPECT_EQ(seen[0], seen[1]);
    }
}

TEST(Antialias, ManyRaysAreAskedForAtOnce) {
    const ImageSize size{320, 240};
    const auto ball = [](const dvec2& at) {
        return vec3(glm::length(at - dvec2(160, 120)) < 100 ? 1.0f : 0.0f);
    };
    EXPECT_LE(traced(size, {}, ball).calls, 5u);
    EXPECT_LE(traced(size, {.method = Method::Subdivide}, ball).calls, 3u);
}

TEST(Antialias, ShowsNothingWhereTracingStops) {
    FunctionTracer tracer(half_white);
    tracer.max_calls = 2;
    Film film(kSize.width, kSize.height);
    EXPECT_FALSE(antialias({.threshold = 0}, 1, tracer, film));
    EXPECT_EQ(tracer.calls, 2u);
    EXPECT_EQ(film.pixels_done(), 0u);
}

} // namespace
} // namespace ovc
