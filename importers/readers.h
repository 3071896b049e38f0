// SPDX-License-Identifier: Apache-2.0
// The readers that importer.cpp chooses from: one function a format, each as load() is documented.
#pragma once

#include "importers/importer.h"

#include <string_view>

namespace ovc {

/// In one mesh: prims are numbered in 32 bits, and kNone is none.
inline constexpr uint64_t kMaxTriangles = 0xfffffffe;

Result<Scene> read_ply(const std::filesystem::path& path, const ImportOptions& options);
Result<Scene> read_obj(const std::filesystem::path& path, const ImportOptions& options);
Result<Scene> read_ovc(const std::filesystem::path& path, const ImportOptions& options);
Result<Scene> read_pbrt(const std::filesystem::path& path, const ImportOptions& options);
Result<Scene> read_pov(const std::filesystem::path& path, const ImportOptions& options);
Result<Scene> read_assimp(const std::filesystem::path& path, const ImportOptions& options);

/// More than scenes run over: some twenty seconds of work.
inline constexpr uint64_t kMaxPovWords = 500'000'000;

/// read_pov() of a text; path: whose it is said to be, and beside which includes are looked for.
/// max_words: what loops and macros may run over in all.
Result<Scene> parse_pov(std::string text, const std::filesystem::path& path,
                        const ImportOptions& options, uint64_t max_words = kMaxPovWords);

/// Whether Assimp names this extension (without the dot, lower case) as one it reads.
bool assimp_reads(std::string_view extension);

Result<Done> write_ovc(const Scene& scene, const std::filesystem::path& path);
Result<Done> write_ply(const Scene& scene, const std::filesystem::path& path);
Result<Done> write_obj(const Scene& scene, const std::filesystem::path& path);

} // namespace ovc
