// SPDX-License-Identifier: Apache-2.0
#include "gpu/gl/program_store.h"

#include "gpu/gl/kernel.h"
#include "gpu/gl/test_gl.h"

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

namespace ovc {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kSources = {
    "#version 450\nlayout(local_size_x = 1) in;\nlayout(binding = 0) buffer B { uint b; };\n"
    "void main() { b = 7u; }\n"};

class ProgramStoreGl : public test::OnGl {
protected:
    void SetUp() override {
        OnGl::SetUp();
        std::string name = (fs::temp_directory_path() / "ovc-programs-XXXXXX").string();
        ASSERT_TRUE(mkdtemp(name.data()));
        folder = name;
        if (!gl)
            return;
        GLint formats = 0;
        gl->run([&](GlState&) { glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &formats); });
        if (formats == 0)
            GTEST_SKIP() << "the driver hands out no programs";
    }
    void TearDown() override {
        fs::permissions(folder, fs::perms::owner_all);
        fs::remove_all(folder);
    }

    static gl::Program linked() {
        gl::Program program(glCreateProgram());
        const gl::Shader shader(glCreateShader(GL_COMPUTE_SHADER));
        const char* text = kSources[0].c_str();
        glShaderSource(shader.id(), 1, &text, nullptr);
        glCompileShader(shader.id());
        glAttachShader(program.id(), shader.id());
        glLinkProgram(program.id());
        return program;
    }

    /// Returns the number that the program from the store writes; 0 if none was found.
    uint32_t found(const ProgramStore& store, const std::vector<std::string>& sources = kSources) {
        uint32_t written = 0;
        gl->run([&](GlState&) {
            const gl::Program program(glCreateProgram());
            if (!store.load(sources, program.id()))
                return;
            GLuint buffer = 0;
            glCreateBuffers(1, &buffer);
            glNamedBufferStorage(buffer, 4, &written, 0);
            glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer);
            glUseProgram(program.id());
            glDispatchCompute(1, 1, 1);
            glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
            glGetNamedBufferSubData(buffer, 0, 4, &written);
            glDeleteBuffers(1, &buffer);
            EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
        });
        return written;
    }

    void keep(const ProgramStore& store, const std::vector<std::string>& sources = kSources) {
        gl->run([&](GlState&) { store.keep(sources, linked().id()); });
    }

    std::vector<fs::path> files() const {
        std::vector<fs::path> all;
        for (const auto& entry : fs::directory_iterator(folder))
            all.push_back(entry.path());
        return all;
    }

    fs::path folder;
};

TEST_F(ProgramStoreGl, FindsWhatWasKeptForTheSameSourcesAlone) {
    const ProgramStore store(folder / "made" / "here");
    EXPECT_EQ(found(store), 0u);
    keep(store);
    EXPECT_EQ(found(store), 7u);
    EXPECT_EQ(found(ProgramStore(folder / "made" / "here")), 7u);
    EXPECT_EQ(found(store, {kSources[0] + "\n"}), 0u);
    EXPECT_EQ(found(store, {"", kSources[0]}), 0u);
    EXPECT_EQ(found(ProgramStore({})), 0u);
    keep(ProgramStore({}));
}

TEST_F(ProgramStoreGl, WhatIsDamagedIsNotFoundAndReplaced) {
    const ProgramStore store(folder);
    keep(store);
    ASSERT_EQ(files().size(), 1u);
    const fs::path file = files()[0];
    const uint64_t size = fs::file_size(file);
    for (const uint64_t at : {uint64_t(0), size / 3, size / 2, size - 1}) {
        std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
        bytes.seekg(std::streamoff(at));
        const char old = char(bytes.get());
        bytes.seekp(std::streamoff(at));
        bytes.put(char(old ^ 0x55));
        bytes.close();
        EXPECT_EQ(found(store), 0u) << "byte " << at;
        keep(store);
        EXPECT_EQ(found(store), 7u);
    }
    for (const uint64_t cut : {size / 2, uint64_t(0)}) {
        fs::resize_file(file, cut);
        EXPECT_EQ(found(store), 0u);
    }
    keep(store);
    EXPECT_EQ(found(store), 7u);
    EXPECT_EQ(files().size(), 1u);
}

TEST_F(ProgramStoreGl, AFolderThatCannotBeWrittenToIsNoError) {
    const ProgramStore under_a_file(folder / "file" / "kernels");
    std::ofstream(folder / "file") << "in the way";
    keep(under_a_file);
    EXPECT_EQ(found(under_a_file), 0u);

    const fs::path closed = folder / "closed";
    keep(ProgramStore(closed));
    fs::permissions(closed, fs::perms::owner_read | fs::perms::owner_exec);
    keep(ProgramStore(closed), {"other"});
    EXPECT_EQ(found(ProgramStore(closed)), 7u);
    fs::permissions(closed, fs::perms::owner_all);
}

TEST_F(ProgramStoreGl, WhatWasUsedLongestAgoGoesFirst) {
    keep(ProgramStore(folder));
    const uint64_t one = fs::file_size(files()[0]);
    const ProgramStore store(folder, 3 * one + one / 2);
    const auto hour = std::chrono::hours(1);
    for (const char* name : {"a", "b"})
        keep(store, {name});
    for (const fs::path& file : files())
        fs::last_write_time(file, fs::file_time_type::clock::now() - hour);
    EXPECT_EQ(found(store), 7u); // which marks it as used now
    keep(store, {"c"});
    keep(store, {"d"});
    EXPECT_EQ(files().size(), 3u);
    EXPECT_EQ(found(store), 7u);
}

TEST_F(ProgramStoreGl, ManyMayKeepAndFindAtOnce) {
    std::vector<pid_t> children;
    for (int child = 0; child < 2; ++child) {
        const std::string name = folder.string();
        const pid_t pid = fork();
        ASSERT_GE(pid, 0);
        if (pid == 0) { // runs the test below in another process
            setenv("OVC_PROGRAM_STORE_FOLDER", name.c_str(), 1);
            for (const char* share : {"GTEST_TOTAL_SHARDS", "GTEST_SHARD_INDEX"})
                unsetenv(share); // this process's tests may be one of several shares
            execl("/proc/self/exe", "gpu_test", "--gtest_filter=ProgramStoreGl.AnotherProcess*",
                  nullptr);
            _exit(3);
        }
        children.push_back(pid);
    }
    for (const pid_t pid : children) {
        int status = 0;
        waitpid(pid, &status, 0);
        EXPECT_EQ(status, 0);
    }
    EXPECT_EQ(found(ProgramStore(folder)), 7u);
    EXPECT_EQ(files().size(), 1u); // no temporary file is left
}

/// The test above runs this one in two processes.
TEST_F(ProgramStoreGl, AnotherProcessKeepsAndFinds) {
    const char* shared = std::getenv("OVC_PROGRAM_STORE_FOLDER");
    if (!shared)
        GTEST_SKIP() << "is a part of ManyMayKeepAndFindAtOnce";
    const ProgramStore store{fs::path(shared)};
    keep(store);
    for (int i = 0; i < 100; ++i) {
        keep(store);
        ASSERT_EQ(found(store), 7u); // the file is always whole
    }
}

/// Sets environment variables while it lives.
class Environment {
public:
    explicit Environment(std::vector<std::pair<const char*, const char*>> values) {
        for (const auto& [name, value] : values) {
            const char* before = std::getenv(name);
            before_.push_back({name, before ? std::optional<std::string>(before) : std::nullopt});
            value ? setenv(name, value, 1) : unsetenv(name);
        }
    }
    ~Environment() {
        for (const auto& [name, value] : before_)
            value ? setenv(name, value->c_str(), 1) : unsetenv(name);
    }

private:
    std::vector<std::pair<const char*, std::optional<std::string>>> before_;
};

TEST(ProgramStore, TheFolderIsTheUsersCacheUnlessToldOtherwise) {
    const auto folder = [](const char* named, const char* xdg, const char* home) {
        const Environment set(
            {{"OVC_KERNEL_CACHE", named}, {"XDG_CACHE_HOME", xdg}, {"HOME", home}});
        return ProgramStore::default_folder().string();
    };
    EXPECT_EQ(folder("off", "/x", "/h"), "");
    EXPECT_EQ(folder("/n", "/x", "/h"), "/n");
    EXPECT_EQ(folder("", "/x", "/h"), "/x/overcast/kernels");
    EXPECT_EQ(folder(nullptr, "not/absolute", "/h"), "/h/.cache/overcast/kernels");
    EXPECT_EQ(folder(nullptr, nullptr, "/h"), "/h/.cache/overcast/kernels");
    EXPECT_EQ(folder(nullptr, nullptr, nullptr), "");
}

} // namespace
} // namespace ovc
