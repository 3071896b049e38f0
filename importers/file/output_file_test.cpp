// SPDX-License-Identifier: Apache-2.0
// OutputFile keeps the kind of its target, and files appear whole or not at all.
#include "importers/file/output_file.h"
#include "importers/test_files.h"

#include <gmock/gmock.h>

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <thread>

namespace ovc {
namespace {

namespace fs = std::filesystem;

class OutputFileTest : public testing::Test {
protected:
    /// Returns the error's message; empty if the text was written.
    std::string save(const fs::path& path, std::string_view text) const {
        Result<OutputFile> file = OutputFile::create(path);
        if (!file)
            return folder.plain(file.error().message);
        file->write(text);
        const Result<Done> done = file->commit();
        return done ? "" : folder.plain(done.error().message);
    }
    size_t file_count() const {
        return size_t(std::distance(fs::directory_iterator(folder / ""), fs::directory_iterator()));
    }

    TestFolder folder;
};

TEST_F(OutputFileTest, ReplacesWhatALinkLeadsTo) {
    folder.write("real", "old");
    fs::create_symlink("real", folder / "link");
    fs::create_symlink("new", folder / "dangling");
    EXPECT_EQ(save(folder / "link", "text"), "");
    EXPECT_EQ(save(folder / "dangling", "fresh"), "");
    EXPECT_TRUE(fs::is_symlink(folder / "link"));
    EXPECT_EQ(folder.read("real"), "text");
    EXPECT_EQ(folder.read("new"), "fresh");
    EXPECT_EQ(file_count(), 4u);
    fs::create_symlink("loop", folder / "loop");
    EXPECT_EQ(save(folder / "loop", ""),
              "loop: cannot be written: Too many levels of symbolic links");
}

TEST_F(OutputFileTest, WritesDevicesAndFifosThrough) {
    fs::create_symlink("/dev/null", folder / "null");
    EXPECT_EQ(save(folder / "null", "text"), "");
    EXPECT_TRUE(fs::is_character_file(folder / "null"));
    EXPECT_TRUE(fs::is_symlink(folder / "null"));

    ASSERT_EQ(mkfifo((folder / "fifo").c_str(), 0600), 0);
    std::string read;
    std::thread reader([&] { read = folder.read("fifo"); });
    EXPECT_EQ(save(folder / "fifo", "text"), "");
    reader.join();
    EXPECT_EQ(read, "text");
    EXPECT_TRUE(fs::is_fifo(folder / "fifo"));
    if (fs::exists("/dev/full")) {
        EXPECT_EQ(save("/dev/full", "text"),
                  "/dev/full: cannot be written: No space left on device");
    }
}

TEST_F(OutputFileTest, RefusesWhatIsNoFile) {
    fs::create_directory(folder / "folder");
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string name = folder / "socket";
    ASSERT_LT(name.size(), sizeof(address.sun_path));
    std::copy(name.begin(), name.end(), address.sun_path);
    const int socket_end = socket(AF_UNIX, SOCK_STREAM, 0);
    ASSERT_EQ(bind(socket_end, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
    EXPECT_EQ(save(folder / "folder", ""), "folder: found a directory, expected a file to write");
    EXPECT_EQ(save(folder / "socket", ""), "socket: found a socket, expected a file to write");
    EXPECT_EQ(save(folder / "none" / "file", ""), "none/file: the folder does not exist");
    EXPECT_TRUE(fs::is_socket(folder / "socket"));
    close(socket_end);
}

TEST_F(OutputFileTest, IsTriedBeforehandWithoutATrace) {
    folder.write("old", "text");
    fs::create_symlink("new", folder / "dangling");
    for (const char* name : {"old", "dangling", "none"})
        EXPECT_TRUE(OutputFile::check(folder / name)) << name;
    EXPECT_EQ(folder.read("old"), "text");
    EXPECT_EQ(file_count(), 2u) << "nothing is left behind";
    // Root has permission, and still cannot make a file there.
    const Result<Done> refused = OutputFile::check("/proc/a.png");
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message,
                testing::StartsWith("/proc/a.png: the folder cannot be written to: "));
}

TEST_F(OutputFileTest, TakesEveryNameThatFits) {
    const std::string longest(255, 'n');
    EXPECT_EQ(save(folder / longest, "text"), "");
    EXPECT_EQ(folder.read(longest), "text");
    EXPECT_EQ(save(folder / (longest + "n"), ""),
              longest + "n: cannot be written: File name too long");
}

TEST_F(OutputFileTest, AHandlerCanRemoveWhatIsUnfinished) {
    {
        const Result<OutputFile> file = OutputFile::create(folder / "a");
        ASSERT_TRUE(file);
        EXPECT_EQ(file_count(), 1u);
        remove_unfinished_output();
        EXPECT_EQ(file_count(), 0u);
    }
    EXPECT_EQ(save(folder / "a", "text"), "");
    remove_unfinished_output();
    EXPECT_EQ(folder.read("a"), "text");
}

TEST_F(OutputFileTest, KnowsTheSameFileByAnyName) {
    folder.write("a", "");
    fs::create_symlink("a", folder / "link");
    fs::create_symlink("new", folder / "dangling");
    fs::create_directory(folder / "sub");
    EXPECT_TRUE(is_same_output(folder / "a", folder / "link"));
    EXPECT_TRUE(is_same_output(folder / "a", folder / "sub" / ".." / "a"));
    EXPECT_TRUE(is_same_output(folder / "new", folder / "dangling"));
    EXPECT_TRUE(is_same_output("none", "./none"));
    EXPECT_FALSE(is_same_output(folder / "a", folder / "b"));
    EXPECT_FALSE(is_same_output("/dev/null", "/dev/null"));
}

} // namespace
} // namespace ovc
