// SPDX-License-Identifier: Apache-2.0
// OutputFile: written beside its target, put in the target's place only once complete.
#pragma once

#include "core/result.h"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

namespace ovc {

/// What was not committed is removed. A failed write is kept in mind: commit() reports it.
class OutputFile {
public:
    /// Fails where the folder does not exist or cannot be written to.
    static Result<OutputFile> create(const std::filesystem::path& target);

    OutputFile(OutputFile&&) = default;
    OutputFile& operator=(OutputFile&&) = delete;
    ~OutputFile();

    void write(const void* data, size_t bytes);
    void write(std::string_view text) { write(text.data(), text.size()); }

    Result<Done> commit();

private:
    struct CloseFile {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };

    OutputFile(std::filesystem::path target, std::filesystem::path temporary, std::FILE* file)
        : target_(std::move(target)), temporary_(std::move(temporary)), file_(file) {}

    Error failed() const;

    std::filesystem::path target_;
    std::filesystem::path temporary_;
    std::unique_ptr<std::FILE, CloseFile> file_;
    int error_number_ = 0; // of the first write that failed
};

} // namespace ovc
