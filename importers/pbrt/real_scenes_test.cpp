// SPDX-License-Identifier: Apache-2.0
// These tests compare scenes of pbrt-v1 to v4 that others made with an independent program's
// reading of them.
#include "importers/test_files.h"
#include "tests/real_data.h"

#include <charconv>

#include <sys/resource.h>

namespace ovc {
namespace {

/// Returns the text behind `"key": ` in a line of JSON.
std::string_view after(const std::string& line, const std::string& key) {
    const size_t at = line.find("\"" + key + "\": ");
    return at == line.npos ? std::string_view()
                           : std::string_view(line).substr(at + key.size() + 4);
}

double number_at(std::string_view& text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    EXPECT_EQ(error, std::errc()) << text.substr(0, 20);
    text.remove_prefix(size_t(end - text.data()));
    return value;
}

dvec3 point_at(std::string_view text) {
    dvec3 p(0);
    for (int axis = 0; axis < 3; ++axis) {
        text.remove_prefix(axis == 0 ? 1 : 2); // [ and ", "
        p[axis] = number_at(text);
    }
    return p;
}

Box bounds_of(const Scene& scene) {
    Box bounds;
    hittable_triangles(scene.soup, nullptr, &bounds);
    return bounds;
}

TEST(PbrtRealScenes, AgreeWithAnotherReadingWhereThatIsWhole) {
    const auto data = real_data();
    if (!data)
        GTEST_SKIP() << kNoRealData;
    std::ifstream index(real_data_index() / "expect_pbrt.jsonl");
    int compared = 0;
    uint64_t largest = 0;
    for (std::string line; std::getline(index, line);) {
        std::string_view name = after(line, "scene").substr(1);
        name = name.substr(0, name.find('"'));
        std::string_view flat = after(line, "flat_tris"), unique = after(line, "unique_tris");
        const auto flat_count = uint64_t(number_at(flat));
        // The large scenes of plants come in seven versions, of which one suffices.
        if (!after(line, "not_flattened").starts_with("{}") ||
            (flat_count > 1000000 && name.find("noapple") == name.npos))
            continue;
        const auto scene = load(*data / std::string(name));
        ASSERT_TRUE(scene) << scene.error().message;
        EXPECT_EQ(scene->soup.triangle_count(), flat_count) << name;
        EXPECT_EQ(scene->instancing->unique_triangles, uint64_t(number_at(unique))) << name;
        ++compared;
        largest = std::max(largest, flat_count);
        if (flat_count == 0)
            continue;
        const Box found = bounds_of(*scene);
        const dvec3 low = point_at(after(line, "bbox_min")),
                    high = point_at(after(line, "bbox_max"));
        const double allowed = 1e-5 * max_component(high - low);
        EXPECT_LT(max_component(glm::abs(found.lo - low)), allowed) << name;
        EXPECT_LT(max_component(glm::abs(found.hi - high)), allowed) << name;
    }
    EXPECT_GE(compared, 27);
    EXPECT_EQ(largest, 12341853u);
}

/// The peak is the process's, so this test must not share one with others; CTest runs each test in
/// its own.
TEST(PbrtRealScenes, PlantsPeakAtLittleMoreThanTheirSoup) {
    const auto data = real_data();
    if (!data)
        GTEST_SKIP() << kNoRealData;
    const auto peak = [] {
        rusage usage{};
        getrusage(RUSAGE_SELF, &usage);
        return uint64_t(usage.ru_maxrss) << 10;
    };
    const uint64_t before = peak();
    const auto scene = load(*data / "pbrt/v1-pharr/plants-noapple-nodandelion.pbrt");
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->instancing->instances, 4685u);
    if (before > uint64_t(100) << 20)
        GTEST_SKIP() << "other tests ran in this process";
#ifndef __SANITIZE_ADDRESS__
    EXPECT_LT(peak() - before, uint64_t(1.5 * 36 * 12341853));
#endif
}

} // namespace
} // namespace ovc
