// SPDX-License-Identifier: Apache-2.0
// Settings of .ini files become the words that they stand for.
#include "host/arguments/pov_words.h"
#include "importers/test_files.h"

#include <gmock/gmock.h>

namespace ovc {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

using Settings = std::vector<std::string>;

Settings translated_settings(const Settings& words) {
    const Result<Settings> ours = translate_pov_words(words, {});
    return ours ? *ours : Settings{"Error: " + ours.error().message};
}

TEST(PovIni, SettingsAreWords) {
    const TestFolder folder;
    const std::string ini = folder
                                .write("a.ini", "; a comment\nInput_File_Name = \"a b.pov\"\n"
                                                "Width=640\nHeight=480 ; high\nDisplay=off\n"
                                                "Version=3.1\nAntialias_Threshold=0.1\n"
                                                "+WT2 -P\n[Fine]\nAntialias=On\n"
                                                "Sampling_Method=2\nJitter=off\n[Other]\n+Q3\n")
                                .string();
    EXPECT_THAT(translated_settings({ini}),
                ElementsAre("a b.pov", "--pov-version=3.1", "--threads=2", "--size=640x480"));
    EXPECT_THAT(translated_settings({ini + "[fine]", "+W8", "+H6"}),
                ElementsAre("a b.pov", "--pov-version=3.1", "--threads=2", "--size=8x6",
                            "--antialias=0.1", "--antialias-method=2", "--jitter=0"));
}

TEST(PovIni, FilesOfOtherSystemsAreRead) {
    const TestFolder folder;
    const std::string ini =
        folder.write("a.ini", "\xef\xbb\xbfInput_File_Name=a.pov\r\nWork_Threads=2\r\n").string();
    EXPECT_THAT(translated_settings({ini}), ElementsAre("a.pov", "--threads=2"));
}

TEST(PovIni, SettingsMayStandOnTheCommandLine) {
    EXPECT_THAT(translated_settings({"Width=8", "Height=6", "a.pov", "seed=3"}),
                ElementsAre("a.pov", "seed=3", "--size=8x6"));
}

TEST(PovIni, WhatIsWrongIsNamedWithItsLine) {
    const TestFolder folder;
    const std::string ini = folder.write("a.ini", "Width=8\nBanana=3\n").string();
    EXPECT_THAT(translated_settings({ini}),
                ElementsAre("Error: " + ini +
                            ":2: 'banana' is no setting of POV-Ray's that is "
                            "understood here"));
    const std::string self = (folder / "b.ini").string();
    folder.write("b.ini", self + "\n");
    EXPECT_THAT(translated_settings({self}).at(0), HasSubstr("name each other without an end"));
    EXPECT_THAT(translated_settings({(folder / "none.ini").string()}).at(0),
                HasSubstr("none.ini: no such file"));
    std::filesystem::create_directory(folder / "folder.ini");
    EXPECT_THAT(translated_settings({(folder / "folder.ini").string()}).at(0),
                HasSubstr("folder.ini: found a directory"));
    std::filesystem::create_symlink("/dev/zero", folder / "zero.ini");
    EXPECT_THAT(translated_settings({(folder / "zero.ini").string()}).at(0),
                HasSubstr("zero.ini: found a device"));
}

} // namespace
} // namespace ovc
