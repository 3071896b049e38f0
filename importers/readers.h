// SPDX-License-Identifier: Apache-2.0
// The readers and writers that importer.cpp chooses from; they keep the promises of load(), save().
#pragma once

#include "importers/importer.h"

#include <string_view>

namespace ovc {

/// The host memory that a mesh of a scene that streams takes: its name, and its places in tables up
/// to those of the plugin. An OBJ file of 50,000 groups took 1,890 bytes for each.
inline constexpr uint64_t kMeshBytes = 2000;

Result<Scene> read_ply(const std::filesystem::path& path, const ImportOptions& options);
Result<Scene> read_obj(const std::filesystem::path& path, const ImportOptions& options);
Result<Scene> read_ovc(const std::filesystem::path& path, const ImportOptions& options);
Result<Scene> read_pbrt(const std::filesystem::path& path, const ImportOptions& options);
Result<Scene> read_pov(const std::filesystem::path& path, const ImportOptions& options);
Result<Scene> read_assimp(const std::filesystem::path& path, const ImportOptions& options);

/// More words than real scenes run over: some twenty seconds of work.
inline constexpr uint64_t kMaxPovWords = 500'000'000;

/// Reads `text` as read_pov() reads a file. Messages name `path`, and includes are looked for
/// beside it. Loops and macros may run over `max_words` words in all.
Result<Scene> parse_pov(std::string text, const std::filesystem::path& path,
                        const ImportOptions& options, uint64_t max_words = kMaxPovWords);

/// Returns whether Assimp reads files with this extension (without the dot, lower case).
bool assimp_reads(std::string_view extension);

Result<Done> write_ovc(const Scene& scene, const std::filesystem::path& path);
Result<Done> write_ply(const Scene& scene, const std::filesystem::path& path);
Result<Done> write_obj(const Scene& scene, const std::filesystem::path& path);

} // namespace ovc
