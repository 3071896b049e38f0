// SPDX-License-Identifier: Apache-2.0
// Faults of a reader are sentences, and what it reads comes back as it is.
#include "importers/scene_file/read_apart.h"
#include "importers/test_files.h"

#include <gtest/gtest.h>

#include <sys/resource.h>

#include <atomic>
#include <csignal>
#include <vector>

namespace ovc {
namespace {

/// Returns the error's sentence; nothing where a scene was read.
std::string failure_of(SceneReader reader) {
    const Result<Scene> scene = read_apart(reader, "Someone", "a.xyz", {});
    return scene ? "" : scene.error().message;
}

TEST(ReadApart, ACrashIsASentence) {
    EXPECT_EQ(failure_of([](const std::filesystem::path&, const ImportOptions&) -> Result<Scene> {
                  std::raise(SIGSEGV);
                  return Scene();
              }),
              "a.xyz: Someone crashed (Segmentation fault), expected a file that it can read");
}

TEST(ReadApart, AnErrorComesBack) {
    EXPECT_EQ(failure_of([](const std::filesystem::path& path, const ImportOptions&) {
                  return Result<Scene>(Error{path.string() + ": found nothing"});
              }),
              "a.xyz: found nothing");
}

TEST(ReadApart, MemoryIsBoundedByWhatFilesHold) {
    EXPECT_EQ(failure_of([](const std::filesystem::path&, const ImportOptions&) -> Result<Scene> {
                  std::vector<std::vector<char>> all;
                  while (true)
                      all.emplace_back(size_t(64) << 20);
              }),
              "a.xyz: found a model that takes more memory than is free, or than its files can "
              "hold");
}

TEST(ReadApart, TimeIsBounded) {
    EXPECT_EQ(failure_of([](const std::filesystem::path&, const ImportOptions&) -> Result<Scene> {
                  const rlimit soon{1, 2}; // sooner than the minute that the child has
                  setrlimit(RLIMIT_CPU, &soon);
                  for (std::atomic<int> turn{0};;)
                      ++turn;
              }),
              "a.xyz: Someone does not come to an end, expected a file that it can read");
}

Result<Scene> read_small(const std::filesystem::path& path, const ImportOptions& options) {
    note(options.files, path);
    say(options.log, LogLevel::Warning, "something left out");
    Scene scene;
    scene.name = "small";
    scene.materials.emplace_back().color = vec3(1, 0, 0.5f);
    scene.add_mesh("m", 0, Chunk::owning(dvec3(5), {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)}), {});
    return scene;
}

TEST(ReadApart, ASceneComesBackWithItsWarningsAndFiles) {
    const TestFolder folder;
    const std::filesystem::path path = folder.write("a.xyz", "12345");
    std::vector<std::string> warnings;
    FilesRead files;
    ImportOptions options = gather(warnings);
    options.files = &files;
    const Result<Scene> scene = read_apart(read_small, "Someone", path, options);
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->name, "small");
    EXPECT_EQ(scene->materials[0].color, vec3(1, 0, 0.5f));
    EXPECT_EQ(scene->soup.triangle({0, 0})[1], dvec3(6, 5, 5));
    EXPECT_EQ(warnings, std::vector<std::string>{"something left out"});
    ASSERT_EQ(files.stamps().size(), 1u);
    EXPECT_EQ(files.stamps()[0].bytes, 5u);
}

TEST(ReadApart, ChildrenMayBeIgnored) {
    const auto before = std::signal(SIGCHLD, SIG_IGN);
    const Result<Scene> scene = read_apart(read_small, "Someone", "a.xyz", {});
    const std::string failure =
        failure_of([](const std::filesystem::path& path, const ImportOptions&) {
            return Result<Scene>(Error{path.string() + ": found nothing"});
        });
    std::signal(SIGCHLD, before);
    EXPECT_TRUE(scene && scene->name == "small");
    EXPECT_EQ(failure, "a.xyz: found nothing");
}

} // namespace
} // namespace ovc
