// SPDX-License-Identifier: Apache-2.0
// TriangleStore and ScratchFile: what went in comes out, nothing is left behind, and a disk that
// fails is a sentence.
#include "importers/scratch/triangle_store.h"
#include "tests/file_size_limit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <vector>

namespace ovc {
namespace {

namespace fs = std::filesystem;

struct Folder {
    fs::path path = fs::path(testing::TempDir()) / "triangle_store_test";

    Folder() {
        fs::remove_all(path);
        fs::create_directories(path);
    }
    ~Folder() { fs::remove_all(path); }
};

std::vector<vec3> numbered(size_t count, float from) {
    std::vector<vec3> items;
    for (size_t i = 0; i < count; ++i)
        items.emplace_back(from + float(i), -float(i), 0.5f);
    return items;
}

std::vector<vec3> written(const std::function<Result<Done>(const ByteSink&)>& write) {
    std::vector<vec3> items;
    EXPECT_TRUE(write([&](Bytes bytes) {
        const size_t before = items.size();
        items.resize(before + bytes.size() / sizeof(vec3));
        std::memcpy(&items[before], bytes.data(), bytes.size());
        return true;
    }));
    return items;
}

TEST(TriangleStore, GivesBackWhatItTook) {
    const Folder folder;
    Result<TriangleStore> store = TriangleStore::create(folder.path);
    ASSERT_TRUE(store);
    const std::vector<vec3> first = numbered(300'000, 1), second = numbered(30, 7);
    store->begin_mesh();
    for (size_t at = 0; at < first.size(); at += 30'000)
        EXPECT_TRUE(store->add_corners(std::span(first).subspan(at, 30'000)));
    store->begin_mesh();
    store->begin_mesh();
    EXPECT_TRUE(store->add_corners(second) && store->add_normals(first));
    ASSERT_TRUE(store->finish());
    EXPECT_TRUE(fs::is_empty(folder.path)) << "scratch files have no names";
    ASSERT_EQ(store->meshes(), 3u);
    EXPECT_EQ(store->corners(0), first.size());
    EXPECT_EQ(store->corners(1), 0u);
    EXPECT_EQ(store->corners(2), second.size());
    EXPECT_EQ(store->normals(0), 0u);
    EXPECT_EQ(store->normals(2), first.size());
    EXPECT_EQ(store->triangles(), (first.size() + second.size()) / 3);
    std::vector<vec3> some(9);
    EXPECT_TRUE(store->read_corners(0, 123'456, some));
    EXPECT_TRUE(std::ranges::equal(some, std::span(first).subspan(123'456, 9)));
    EXPECT_TRUE(store->read_corners(2, 21, some));
    EXPECT_TRUE(std::ranges::equal(some, std::span(second).subspan(21, 9)));
    const auto corners = written([&](const ByteSink& sink) { return store->write_corners(sink); });
    ASSERT_EQ(corners.size(), first.size() + second.size());
    EXPECT_EQ(corners[299'999], first[299'999]);
    EXPECT_EQ(corners[300'000], second[0]);
    EXPECT_EQ(written([&](const ByteSink& sink) { return store->write_normals(sink); }), first);
}

TEST(TriangleStore, GoesOnWithMeshesThatWereLeft) {
    const Folder folder;
    Result<TriangleStore> store = TriangleStore::create(folder.path);
    ASSERT_TRUE(store);
    std::vector<std::vector<vec3>> meshes(3);
    for (size_t m = 0; m < meshes.size(); ++m)
        store->begin_mesh();
    for (size_t i = 0; i < 60; ++i) {
        const size_t m = i * i % 3; // 0, 1, 1, 0, 1, 1
        const std::vector<vec3> part = numbered(3 * (i * 977 % 9000), float(i));
        meshes[m].insert(meshes[m].end(), part.begin(), part.end());
        store->go_on_with(m);
        EXPECT_TRUE(store->add_corners(part) && store->add_normals(part));
        if (i == 30)
            store->drop_normals(0);
    }
    store->drop_normals(0);
    ASSERT_TRUE(store->finish());
    std::vector<vec3> all;
    for (size_t m = 0; m < meshes.size(); ++m) {
        ASSERT_EQ(store->corners(m), meshes[m].size());
        EXPECT_EQ(store->normals(m), m == 0 ? 0 : meshes[m].size());
        all.insert(all.end(), meshes[m].begin(), meshes[m].end());
        for (size_t at = 0; at + 50'000 < meshes[m].size(); at += 10'007) {
            std::vector<vec3> some(50'000); // of several runs
            EXPECT_TRUE(store->read_corners(m, at, some));
            EXPECT_TRUE(std::ranges::equal(some, std::span(meshes[m]).subspan(at, some.size())));
        }
    }
    EXPECT_EQ(written([&](const ByteSink& sink) { return store->write_corners(sink); }), all);
    EXPECT_EQ(written([&](const ByteSink& sink) { return store->write_normals(sink); }), meshes[1]);
}

TEST(TriangleStore, TellsThatThereIsNoSuchFolder) {
    const Result<TriangleStore> store = TriangleStore::create("/no/such/folder");
    ASSERT_FALSE(store);
    EXPECT_EQ(store.error().message, "/no/such/folder: no scratch file can be made there: No such "
                                     "file or directory");
}

TEST(TriangleStore, TellsThatTheDiskIsFull) {
    const Folder folder;
    const test::FileSizeLimit limit(1 << 20);
    Result<TriangleStore> store = TriangleStore::create(folder.path);
    ASSERT_TRUE(store);
    store->begin_mesh();
    const std::vector<vec3> corners = numbered(120'000, 0);
    bool wanted = true;
    for (int i = 0; i < 3 && wanted; ++i)
        wanted = store->add_corners(corners);
    const Result<Done> finished = store->finish();
    EXPECT_FALSE(wanted);
    ASSERT_FALSE(finished);
    EXPECT_THAT(finished.error().message, testing::EndsWith("failed: File too large"));
}

TEST(ScratchFile, TellsThatBytesAreMissing) {
    const Folder folder;
    Result<ScratchFile> file = ScratchFile::create(folder.path);
    ASSERT_TRUE(file);
    std::vector<std::byte> bytes(10, std::byte(7));
    EXPECT_TRUE(file->write(1'000'000, bytes));
    EXPECT_TRUE(file->read(999'995, bytes)); // zeros come before them
    EXPECT_EQ(bytes[4], std::byte(0));
    EXPECT_EQ(bytes[5], std::byte(7));
    EXPECT_FALSE(file->error());
    EXPECT_FALSE(file->read(1'000'005, bytes));
    ASSERT_TRUE(file->error());
    EXPECT_THAT(file->error()->message, testing::EndsWith("failed: bytes are missing"));
}

} // namespace
} // namespace ovc
