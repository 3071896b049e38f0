// SPDX-License-Identifier: Apache-2.0
// What an interrupted rendering leaves beside its outputs, and --continue goes on from: the picture
// so far, for people, and the film, exactly.
#pragma once

#include "core/result.h"
#include "host/render/film.h"

#include <cstdint>
#include <filesystem>
#include <string>

namespace ovc {

/// "out.png" makes "out.unfinished.png".
std::string unfinished_picture(const std::string& output);

/// The film of the picture whose first output this is: "out.unfinished.film".
std::string unfinished_film(const std::string& output);

/// Writes the pixels that are done. picture: what it is of, as a checksum.
Result<Done> save_film(const Film& film, uint64_t picture, const std::filesystem::path& path);

/// Restores the pixels of a film that save_film() wrote. Error: it is damaged, of another picture,
/// or cannot be read; the film is as it was.
Result<Done> load_film(const std::filesystem::path& path, uint64_t picture, Film& film);

} // namespace ovc
