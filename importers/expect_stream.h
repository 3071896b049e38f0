// SPDX-License-Identifier: Apache-2.0
// What the tests of files that stream share: their sinks, and the comparison with a file that is
// held.
#pragma once

#include "importers/scene_file/scene_file.h"
#include "importers/scratch/triangle_store.h"
#include "importers/test_files.h"

namespace ovc {

/// Wants so many parts, and drops them.
struct FullSink final : TriangleSink {
    int wanted = 1;
    int parts = 0;

    void begin_mesh() override {}
    void go_on_with(size_t) override {}
    void drop_normals(size_t) override {}
    bool add_corners(std::span<const vec3>) override { return ++parts < wanted; }
    bool add_normals(std::span<const vec3>) override { return true; }
};

inline std::string bytes_of_file(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Expects the same warnings and the same scene file, with at most so many bytes of host memory.
inline void expect_streams_as_it_loads(const std::filesystem::path& path, uint64_t host_bytes) {
    SCOPED_TRACE(path.filename().string() + ", " + std::to_string(host_bytes));
    std::vector<std::string> warnings, warnings_of_stream;
    ImportOptions options{[&](LogLevel, const std::string& text) { warnings.push_back(text); }};
    const Result<Scene> held = load(path, options);
    const auto folder = std::filesystem::temp_directory_path();
    Result<TriangleStore> store = TriangleStore::create(folder);
    ASSERT_TRUE(held && store);
    const Streaming streaming{*store, host_bytes, folder};
    options.log = [&](LogLevel, const std::string& text) { warnings_of_stream.push_back(text); };
    options.streaming = &streaming;
    const Result<Scene> streamed = load(path, options);
    ASSERT_TRUE(streamed) << streamed.error().message;
    ASSERT_TRUE(store->finish());
    EXPECT_EQ(warnings, warnings_of_stream);
    EXPECT_EQ(streamed->soup.triangle_count(), 0u);
    ASSERT_EQ(store->meshes(), held->meshes.size());
    for (size_t m = 0; m < held->meshes.size(); ++m) {
        EXPECT_EQ(store->corners(m), 3 * uint64_t(held->soup.chunks[m].size())) << m;
        EXPECT_EQ(store->normals(m), held->meshes[m].normals.size()) << m;
    }
    const std::filesystem::path one = path.string() + ".held", other = path.string() + ".streamed";
    ASSERT_TRUE(write_scene_file(*held, {}, {}, one));
    ASSERT_TRUE(write_scene_file(*streamed, *store, {}, {}, other));
    EXPECT_TRUE(bytes_of_file(one) == bytes_of_file(other))
        << "corners, normals or the rest differ";
}

} // namespace ovc
