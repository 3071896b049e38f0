// SPDX-License-Identifier: Apache-2.0
// OutputFile: written beside its target, put in the target's place only once complete.
#pragma once

#include "core/file/archive.h"
#include "core/result.h"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

namespace ovc {

/// What was not committed is removed. A failed write is kept in mind: commit() reports it. A
/// symbolic link stays: the file that it leads to is replaced. A character device, a FIFO, and the
/// file that standard output or error already goes to are written straight through, and stay what
/// they are.
class OutputFile {
public:
    /// Whether create() would succeed. Makes a file beside the target and removes it again; what is
    /// at the target is not touched. Refused: a directory, a block device, a socket, a folder that
    /// does not exist or takes no files, a name the file system cannot hold.
    static Result<Done> check(const std::filesystem::path& target);

    static Result<OutputFile> create(const std::filesystem::path& target);

    OutputFile(OutputFile&&) = default;
    OutputFile& operator=(OutputFile&&) = delete;
    ~OutputFile();

    void write(const void* data, size_t bytes);
    void write(std::string_view text) { write(text.data(), text.size()); }

    /// Writes what it gets here while this file stays where it is, and always wants more: commit()
    /// says what went wrong.
    ByteSink sink() {
        return [this](Bytes bytes) {
            write(bytes.data(), bytes.size());
            return true;
        };
    }

    Result<Done> commit();

private:
    struct CloseFile {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };

    OutputFile(std::filesystem::path target, std::filesystem::path final_path,
               std::filesystem::path temporary, std::FILE* file)
        : target_(std::move(target)),
          final_path_(std::move(final_path)),
          temporary_(std::move(temporary)),
          file_(file) {}

    /// As far as it can be told without writing.
    static Result<Done> check_place(const std::filesystem::path& target);
    static Result<OutputFile> write_through(const std::filesystem::path& target);
    static Error failed(const std::filesystem::path& target, int error_number);
    static Error folder_refused(const std::filesystem::path& target, int error_number);

    std::filesystem::path target_;     // as given, for messages
    std::filesystem::path final_path_; // what it leads to
    std::filesystem::path temporary_;  // empty: written straight through
    std::unique_ptr<std::FILE, CloseFile> file_;
    int error_number_ = 0; // of the first write that failed
};

/// True when writing to one path would change what is at the other: the same file, whatever links
/// and dots lie between. Never for devices and FIFOs, which anything may share.
bool is_same_output(const std::filesystem::path& a, const std::filesystem::path& b);

/// Removes the temporary file of the OutputFile made last, if it is not complete yet. For a signal
/// handler that ends the process: async-signal-safe.
void remove_unfinished_output() noexcept;

} // namespace ovc
