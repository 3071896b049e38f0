// SPDX-License-Identifier: Apache-2.0
// An interrupted rendering leaves two files beside its outputs: the picture so far for the user,
// and the exact film, from which --continue goes on.
#pragma once

#include "core/result.h"
#include "host/film/film.h"

#include <cstdint>
#include <filesystem>
#include <string>

namespace ovc {

/// Returns the name of the picture so far: "out.unfinished.png" for "out.png".
std::string unfinished_picture(const std::string& output);

/// Returns the name of the film of the picture whose first output this is: "out.unfinished.film".
std::string unfinished_film(const std::string& output);

/// Writes the pixels that are done. picture: a checksum of everything that the picture depends on,
/// except its size and samples.
Result<Done> save_film(const Film& film, uint64_t picture, const std::filesystem::path& path);

/// Restores the pixels of a film that save_film() wrote. Error: it is damaged, of another picture,
/// or cannot be read; `film` is then unchanged.
Result<Done> load_film(const std::filesystem::path& path, uint64_t picture, Film& film);

} // namespace ovc
