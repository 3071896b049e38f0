// SPDX-License-Identifier: Apache-2.0
// GzipFile gives the bytes of a regular file, unpacked where gzip has packed them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace ovc {

/// A file is packed where it begins with the mark of gzip. Members that lie one behind the other
/// are one text, and what else lies behind the last is passed over, as gzip does. A call that a
/// signal interrupts goes on.
class GzipFile {
public:
    /// Returns null where the file cannot be opened; errno then says why.
    static std::unique_ptr<GzipFile> open(const std::filesystem::path& path);
    ~GzipFile();
    GzipFile(const GzipFile&) = delete;

    /// Fills `to`, which is not empty, and returns how many bytes it has got: fewer at the end of
    /// the file, or where `damage` receives why it ends early.
    size_t read(std::span<unsigned char> to, std::string& damage);

    /// Returns whether the file is packed, once some of it has been read.
    bool is_compressed() const { return unpacking_ != nullptr; }

private:
    class Unpacking;

    explicit GzipFile(int descriptor);
    size_t read_plain(std::span<unsigned char> to, std::string& damage);

    const int descriptor_;
    uint64_t offset_ = 0; // of what is read next
    bool has_begun_ = false;
    std::unique_ptr<Unpacking> unpacking_; // null: the file is plain
};

} // namespace ovc
