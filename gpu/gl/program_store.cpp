// SPDX-License-Identifier: Apache-2.0
// ProgramStore: an archive for each program (core/file/archive.h), named after the checksum of its
// sources and its driver.
#include "gpu/gl/program_store.h"

#include "core/file/archive.h"
#include "core/file/disk_file.h"
#include "core/file/replace_file.h"
#include "core/system/folder.h"
#include "core/system/line_allocator.h"
#include "core/text/format_text.h"

#include <algorithm>
#include <cstdlib>

namespace ovc {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kKind = "ovc kernel";
constexpr uint32_t kVersion = 2;
constexpr std::string_view kSuffix = ".ovck";

/// Returns the driver's name. llvmpipe's renderer names its vector width, which Mesa's own cache
/// overlooks.
std::string driver() {
    std::string text;
    for (const GLenum name : {GL_VENDOR, GL_RENDERER, GL_VERSION})
        if (const GLubyte* part = glGetString(name))
            text.append(reinterpret_cast<const char*>(part)).append(1, '\n');
    return text;
}

uint64_t key_of(const std::vector<std::string>& sources, const std::string& driver) {
    Checksum key;
    key.add_value(driver.size());
    key.add(std::as_bytes(std::span(driver)));
    for (const std::string& source : sources) {
        key.add_value(source.size());
        key.add(std::as_bytes(std::span(source)));
    }
    return key.value();
}

/// Whether the driver lists the format. Handing it a binary of any other is a GL error.
bool has_format(GLenum format) {
    GLint count = 0;
    glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &count);
    std::vector<GLint> formats(size_t(std::max(count, 0)));
    if (!formats.empty())
        glGetIntegerv(GL_PROGRAM_BINARY_FORMATS, formats.data());
    return std::find(formats.begin(), formats.end(), GLint(format)) != formats.end();
}

} // namespace

fs::path ProgramStore::default_folder() {
    const auto value = [](const char* name) {
        const char* text = std::getenv(name);
        return std::string(text ? text : "");
    };
    if (const std::string named = value("OVC_KERNEL_CACHE"); !named.empty())
        return named == "off" ? fs::path() : fs::path(named);
    // The XDG base directory specification says that a relative path is to be ignored.
    if (const fs::path cache = value("XDG_CACHE_HOME"); cache.is_absolute())
        return cache / "overcast/kernels";
    if (const fs::path home = value("HOME"); home.is_absolute())
        return home / ".cache/overcast/kernels";
    return {};
}

fs::path ProgramStore::file_of(uint64_t key) const {
    return folder_ / (hexadecimal(key, 16) + std::string(kSuffix));
}

bool ProgramStore::load(const std::vector<std::string>& sources, GLuint program) const {
    if (folder_.empty())
        return false;
    const std::string who = driver();
    const fs::path path = file_of(key_of(sources, who));
    // Not mapped: where a disk fails under a mapped file, a signal ends the host's process.
    const Result<DiskFile> file = DiskFile::open(path);
    if (!file || file->bytes() > max_bytes_)
        return false;
    std::vector<std::byte, LineAllocator<std::byte>> bytes(file->bytes());
    if (!file->read(0, bytes))
        return false;
    const Result<Archive> archive = Archive::open(bytes, kKind, kVersion);
    if (!archive)
        return false;
    const Result<Bytes> from = archive->part("driver");
    const auto format = archive->items<uint32_t>("format", 1);
    const Result<Bytes> binary = archive->part("binary");
    if (!from || !format || !binary || !std::ranges::equal(*from, std::as_bytes(std::span(who))) ||
        !has_format((*format)[0]))
        return false;
    glProgramBinary(program, (*format)[0], binary->data(), GLsizei(binary->size()));
    GLint linked = GL_FALSE;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    std::error_code ignored;
    if (linked) // marks it as used now, so that make_room() removes others first
        fs::last_write_time(path, fs::file_time_type::clock::now(), ignored);
    return linked;
}

void ProgramStore::keep(const std::vector<std::string>& sources, GLuint program) const {
    GLint size = 0;
    if (!folder_.empty())
        glGetProgramiv(program, GL_PROGRAM_BINARY_LENGTH, &size);
    if (size <= 0)
        return;
    std::vector<std::byte> binary(size_t(size), std::byte(0));
    GLenum format = 0;
    GLsizei length = 0;
    glGetProgramBinary(program, size, &length, &format, binary.data());
    binary.resize(size_t(std::clamp<GLsizei>(length, 0, size)));
    if (binary.empty())
        return;

    std::vector<std::byte> bytes;
    ArchiveWriter writer(
        [&](Bytes more) {
            bytes.insert(bytes.end(), more.begin(), more.end());
            return true;
        },
        kKind, kVersion);
    const std::string who = driver();
    const uint32_t number = format;
    writer.part("driver", std::span(std::as_const(who)));
    writer.part("format", std::span(&number, 1));
    writer.part("binary", std::span(std::as_const(binary)));
    writer.finish();

    std::error_code failed;
    fs::create_directories(folder_, failed);
    replace_file(file_of(key_of(sources, who)), bytes);
    make_room();
}

void ProgramStore::make_room() const {
    struct Kept {
        fs::path path;
        fs::file_time_type used;
        uint64_t bytes;
    };
    std::vector<Kept> files;
    uint64_t bytes = 0;
    for (const std::string& name : names_in(folder_)) {
        if (!name.ends_with(kSuffix))
            continue;
        std::error_code gone; // another process may have made room as well
        const fs::path path = folder_ / name;
        const Kept kept{path, fs::last_write_time(path, gone), fs::file_size(path, gone)};
        if (gone)
            continue;
        files.push_back(kept);
        bytes += kept.bytes;
    }
    std::ranges::sort(files, {}, &Kept::used);
    for (const Kept& kept : files) {
        if (bytes <= max_bytes_)
            break;
        std::error_code gone;
        fs::remove(kept.path, gone);
        bytes -= kept.bytes;
    }
}

} // namespace ovc
