// SPDX-License-Identifier: Apache-2.0
// OutputFile is written beside its target and takes the target's place only once it is complete.
#pragma once

#include "core/file/archive.h"
#include "core/result.h"

#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

namespace ovc {

/// The destructor removes a file that was not committed. commit() reports the first write that
/// failed. A symbolic link stays: the file that it leads to is replaced. A character device, a
/// FIFO, and the file that standard output or error already goes to are written straight through,
/// and stay what they are.
class OutputFile {
public:
    /// Checks whether create() would succeed. Makes a file beside the target and removes it again,
    /// but does not touch the target. Refuses a directory, a block device, a socket, a folder that
    /// does not exist or takes no files, and a name that the file system cannot hold.
    static Result<Done> check(const std::filesystem::path& target);

    static Result<OutputFile> create(const std::filesystem::path& target);
    /// Goes on behind the first `offset` bytes of an unfinished file, which is in the target's
    /// folder and stays there until commit() puts it in its place. It is made where there is none.
    static Result<OutputFile> go_on(const std::filesystem::path& target,
                                    const std::filesystem::path& unfinished, uint64_t offset);

    OutputFile(OutputFile&&) = default;
    OutputFile& operator=(OutputFile&&) = delete;
    ~OutputFile();

    void write(const void* data, size_t bytes);
    void write(std::string_view text) { write(text.data(), text.size()); }

    /// Returns a sink that writes to this file, which must stay where it is in memory. The sink
    /// always asks for more: commit() reports errors.
    ByteSink sink() {
        return [this](Bytes bytes) {
            write(bytes.data(), bytes.size());
            return true;
        };
    }

    /// Returns whether a write has failed; commit() then says why.
    bool has_failed() const { return error_number_ != 0; }
    /// Hands all that was written to the system. Error: a write has failed.
    Result<Done> flush();

    /// Puts the file in its place. Nothing may be written after it has succeeded.
    Result<Done> commit();

private:
    /// An open file of the system; -1: none.
    class Descriptor {
    public:
        explicit Descriptor(int number) : number_(number) {}
        Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
        Descriptor& operator=(Descriptor&&) = delete;
        ~Descriptor() { close(); }

        int number() const { return number_; }
        void close();

    private:
        int number_;
    };

    OutputFile(std::filesystem::path target, std::filesystem::path final_path,
               std::filesystem::path temporary, int descriptor)
        : target_(std::move(target)),
          final_path_(std::move(final_path)),
          temporary_(std::move(temporary)),
          file_(descriptor) {}

    /// Does what check() can do without writing.
    static Result<Done> check_place(const std::filesystem::path& target);
    static Result<OutputFile> write_through(const std::filesystem::path& target);
    void hand_over(Bytes bytes);
    void hand_over_waiting();
    static Error failed(const std::filesystem::path& target, int error_number);
    static Error folder_refused(const std::filesystem::path& target, int error_number);

    std::filesystem::path target_;     // as given, for messages
    std::filesystem::path final_path_; // the target with its links followed
    std::filesystem::path temporary_;  // empty: written straight through
    bool stays_ = false;               // where it is not committed
    Descriptor file_;
    std::vector<std::byte> waiting_; // written, but not handed to the system yet
    int error_number_ = 0;           // of the first write that failed
};

/// Follows the path while its last component is a symbolic link, which may dangle.
std::filesystem::path behind_links(std::filesystem::path path);

/// Returns whether writing to one path would change the file at the other, whatever links and dots
/// lie between. False for devices and FIFOs, which anything may share.
bool is_same_output(const std::filesystem::path& a, const std::filesystem::path& b);

/// Removes the temporary file of the OutputFile made last, if it is not complete yet. It is
/// async-signal-safe, for a signal handler that ends the process.
void remove_unfinished_output() noexcept;

} // namespace ovc
