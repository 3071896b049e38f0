// SPDX-License-Identifier: Apache-2.0
// replace_file(): a small file is replaced as a whole, so that whoever reads it at any time finds
// the old bytes or the new ones.
#pragma once

#include "core/file/archive.h"

#include <filesystem>

namespace ovc {

/// Puts the bytes into the file at `path`, in place of what it held. Any number of threads and
/// processes may do so at once. Returns false where the system refuses; the file is then as it was.
/// It does not wait for the disk: after a power cut the file may be empty or cut short, which its
/// reader must be able to tell.
bool replace_file(const std::filesystem::path& path, Bytes bytes);

} // namespace ovc
