// SPDX-License-Identifier: Apache-2.0
// StepFile keeps what a long work has done, step by step, for a later run of the program.
#pragma once

#include "core/file/archive.h"
#include "core/result.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ovc {

/// Each step has its checksum. One that a kill has cut short is dropped, with all behind it.
class StepFile {
public:
    /// Opens the file, or makes it, and reads its steps. work: names the work that they are of; the
    /// file loses those of another. Error: the system refuses, or another process has it open.
    static Result<StepFile> open(const std::filesystem::path& path, std::string_view work);

    StepFile(StepFile&& other) noexcept
        : path_(std::move(other.path_)),
          work_(std::move(other.work_)),
          descriptor_(std::exchange(other.descriptor_, -1)),
          end_(other.end_),
          steps_(std::move(other.steps_)),
          error_number_(other.error_number_) {}
    StepFile& operator=(StepFile&&) = delete;
    ~StepFile();

    const std::filesystem::path& path() const { return path_; }
    /// Returns the steps that are kept.
    std::span<const std::vector<std::byte>> steps() const { return steps_; }
    /// Keeps a step behind those. Returns false where the disk fails; error() then says why.
    bool keep(Bytes step);
    /// Forgets all steps. Returns false where the disk fails.
    bool begin_anew();
    /// Returns the first failure; nothing where there was none.
    std::optional<Error> error() const;

private:
    StepFile(std::filesystem::path path, std::string_view work, int descriptor)
        : path_(std::move(path)), work_(work), descriptor_(descriptor) {}

    void read_steps();
    bool fail(int error_number);

    std::filesystem::path path_;
    std::string work_;
    int descriptor_;
    uint64_t end_ = 0; // of what is whole in the file
    std::vector<std::vector<std::byte>> steps_;
    int error_number_ = 0;
};

} // namespace ovc
