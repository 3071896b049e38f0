// SPDX-License-Identifier: Apache-2.0
// Tests scene files that are cut off at every border of a leaf and of a part, or that have a wrong
// bit in any part: whoever opens one, or traces rays through it, gets the right hits or a sentence.
#include "host/backend/backend.h"
#include "host/scene/scene_cache.h"
#include "importers/scene_file/scene_file.h"
#include "kdtree/test_soups.h"
#include "plugin/build/saved_levels.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>

namespace ovc {
namespace {

namespace fs = std::filesystem;

/// How a scene file is used: a part of it at a time, or mapped.
enum class Way { OnDisk, Mapped };

/// A scene file of some thirty leaves, normals and texture coordinates, and its hits.
class DamagedSceneFile : public testing::Test {
protected:
    void SetUp() override {
        fs::create_directories(folder_);
        Scene scene;
        scene.materials.emplace_back();
        scene.add_mesh("grid", 0, std::move(test::closed_grid(60).chunks[0]));
        scene.meshes[0].normals.assign(3 * scene.soup.triangle_count(), vec3(0, 0, 1));
        scene.meshes[0].uv.assign(3 * scene.soup.triangle_count(), vec2(0.5f));
        rays_ = test::unpleasant_rays(scene.soup, 3, 200);
        BackendOptions options;
        options.kind = BackendKind::TwoLevel;
        options.leaf_triangles = 500;
        const auto built = make_backend(scene.soup, options, {});
        if (!built)
            GTEST_SKIP() << built.error().message;
        ASSERT_TRUE(write_scene_file(scene, {}, levels_of(**built), path_));
        expected_.resize(rays_.size());
        ASSERT_TRUE((*built)->intersect(rays_, {}, expected_));
        std::ifstream file(path_, std::ios::binary);
        whole_.assign(std::istreambuf_iterator<char>(file), {});
        find_places();
    }
    void TearDown() override { fs::remove_all(folder_); }

    /// A scene that has been opened, or why it has not.
    struct Opened {
        std::optional<Scene> scene;
        std::unique_ptr<Backend> backend;
        std::string error;
    };

    Opened open(Way way) const {
        Result<SceneFile> file =
            way == Way::OnDisk ? open_scene_file(path_, kHostBytes) : read_scene_file(path_);
        if (!file)
            return {{}, {}, file.error().message};
        Opened opened{std::move(file->scene), {}, {}};
        BackendOptions options;
        options.kind = BackendKind::TwoLevel;
        options.saved = opened.scene->saved;
        options.on_disk = opened.scene->on_disk.get();
        if (way == Way::OnDisk) {
            options.host_bytes = kHostBytes;
            options.gpu_memory.bytes = kGpuBytes;
        }
        Result<std::unique_ptr<Backend>> backend = make_backend(opened.scene->soup, options, {});
        if (backend)
            opened.backend = std::move(*backend);
        else
            opened.error = backend.error().message;
        return opened;
    }

    /// Traces the rays where there is a scene. Expects the right hits, or a sentence that begins
    /// with the file. Returns the sentence.
    std::string trace(Opened opened) const {
        if (opened.backend) {
            std::vector<Hit> hits(rays_.size());
            const Result<Done> done = opened.backend->intersect(rays_, {}, hits);
            if (!done)
                opened.error = done.error().message;
            else
                EXPECT_EQ(std::memcmp(hits.data(), expected_.data(), hits.size() * sizeof(Hit)), 0);
        }
        if (!opened.error.empty()) {
            EXPECT_TRUE(opened.error.starts_with(path_.string() + ": ")) << opened.error;
        }
        return opened.error;
    }

    /// Returns all that shading may read of the scene, one number for it.
    static uint64_t all_values(const Scene& scene) {
        Checksum sum;
        const auto add = [&](const auto& values) { sum.add(std::as_bytes(std::span(&values, 1))); };
        for (uint32_t prim = 0; prim < scene.soup.chunks[0].size(); ++prim) {
            add(scene.soup.chunks[0].triangle(prim));
            add(scene.normals_of(scene.meshes[0]).of(prim));
            add(scene.uv_of(scene.meshes[0]).of(prim));
        }
        return sum.value();
    }

    void write(const std::string& bytes) const { std::ofstream(path_, std::ios::binary) << bytes; }

    // Less than a third of the file, and of the pages.
    static constexpr uint64_t kHostBytes = 700'000, kGpuBytes = 300'000;
    const fs::path folder_ =
        fs::path(testing::TempDir()) / ("overcast-damaged-" + std::to_string(getpid()));
    const fs::path path_ = folder_ / "scene.ovc";
    std::string whole_;
    std::map<std::string, ArchivePart> parts_; // of the file, and those of its levels
    std::vector<uint64_t> pages_;              // where they begin

private:
    /// Returns the archive that lies there.
    StoredArchive archive_at(uint64_t offset, uint64_t bytes, const char* kind) const {
        uint32_t version = 0;
        std::memcpy(&version, whole_.data() + offset + 16, sizeof(version));
        const auto read = [this, offset](uint64_t at, std::span<std::byte> to) {
            std::memcpy(to.data(), whole_.data() + offset + at, to.size());
            return true;
        };
        const auto archive = StoredArchive::open(read, bytes, kind, version);
        EXPECT_TRUE(archive) << archive.error().message;
        return *archive;
    }

    void find_places() {
        const StoredArchive file = archive_at(0, whole_.size(), "ovc scene");
        for (const char* name : {"fields", "extents", "corners", "normals", "uv", "levels"})
            parts_[name] = file.place(name);
        const ArchivePart all = parts_["levels"];
        const StoredArchive levels = archive_at(all.offset, all.bytes, "ovc levels");
        for (const char* name : {"texels", "lists", "key", "cuts", "twins", "nodes", "leaves",
                                 "pages", "heads", "corner sums"}) {
            parts_[name] = levels.place(name);
            parts_[name].offset += all.offset;
        }
        uint64_t at = parts_["texels"].offset;
        const auto pages = levels.items<SavedPage>("pages");
        ASSERT_TRUE(pages);
        for (const SavedPage& page : *pages) {
            pages_.push_back(at);
            at += page.texels * 16;
        }
        EXPECT_GT(pages_.size(), 20u);
    }

    std::vector<Ray> rays_;
    std::vector<Hit> expected_;
};

TEST_F(DamagedSceneFile, ThatIsCutOffIsSaid) {
    std::vector<uint64_t> borders = pages_;
    for (const auto& [name, part] : parts_) {
        borders.push_back(part.offset);
        borders.push_back(part.offset + part.bytes);
    }
    for (const uint64_t border : borders) {
        SCOPED_TRACE(border);
        if (border == whole_.size())
            continue;
        write(whole_.substr(0, border));
        for (const Way way : {Way::OnDisk, Way::Mapped})
            EXPECT_NE(trace(open(way)), "");
    }
}

/// The scene is open already: reads behind the border fail from then on.
TEST_F(DamagedSceneFile, ThatIsCutOffWhileItIsTracedIsSaid) {
    size_t failed = 0;
    for (const uint64_t border : pages_) {
        SCOPED_TRACE(border);
        write(whole_);
        Opened opened = open(Way::OnDisk);
        ASSERT_TRUE(opened.backend) << opened.error;
        fs::resize_file(path_, border);
        if (const std::string said = trace(std::move(opened)); !said.empty()) {
            ++failed;
            EXPECT_TRUE(said.ends_with("cannot be read: bytes are missing")) << said;
        }
    }
    EXPECT_GT(failed, pages_.size() / 2);
}

TEST_F(DamagedSceneFile, WithAWrongBitGivesRightHitsOrASentence) {
    std::vector<uint64_t> places{
        0, 17, 21, 40, whole_.size() - 1, whole_.size() - 20, whole_.size() - 100};
    for (const auto& [name, part] : parts_) {
        const uint64_t last = part.offset + std::max<uint64_t>(part.bytes, 1) - 1;
        places.insert(places.end(), {part.offset, part.offset + part.bytes / 2, last});
    }
    for (const uint64_t page : pages_)
        places.push_back(page + 100);
    size_t said = 0;
    for (size_t i = 0; i < places.size(); ++i) {
        SCOPED_TRACE(places[i]);
        std::string damaged = whole_;
        damaged[places[i]] ^= char(1 << i % 8);
        write(damaged);
        for (const Way way : {Way::OnDisk, Way::Mapped})
            said += !trace(open(way)).empty();
    }
    EXPECT_GT(said, places.size());
}

/// The library does not see what the host reads by itself.
TEST_F(DamagedSceneFile, GivesShadingRightValuesOrASentence) {
    const auto in_memory = read_scene_file(path_);
    const auto on_disk = open_scene_file(path_, kHostBytes);
    ASSERT_TRUE(in_memory && on_disk);
    EXPECT_EQ(all_values(on_disk->scene), all_values(in_memory->scene));
    EXPECT_TRUE(on_disk->scene.on_disk->checked<Done>(Done{}));
    for (const char* name : {"corners", "normals", "uv"}) {
        std::string damaged = whole_;
        damaged[parts_[name].offset + parts_[name].bytes / 2] ^= 1;
        write(damaged);
        const auto file = open_scene_file(path_, kHostBytes);
        ASSERT_TRUE(file);
        all_values(file->scene);
        const auto read = file->scene.on_disk->checked<Done>(Done{});
        ASSERT_FALSE(read) << name;
        EXPECT_TRUE(read.error().message.starts_with(path_.string() + ": triangles ") &&
                    read.error().message.ends_with("are damaged: their checksum is wrong"))
            << read.error().message;
    }
}

} // namespace
} // namespace ovc
