// SPDX-License-Identifier: Apache-2.0
// LinearInput lets OpenImageIO's cache see a picture in linear light, in tiles and with mipmaps, so
// that filters take means of light. The cache itself knows no encodings.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <string>

#include <OpenImageIO/imageio.h>

namespace ovc {

/// Says why tiles of a picture cannot be read. The cache is not told, because OpenImageIO 2.5 ends
/// the process where a picture fails while several threads ask for it. Any number of threads may
/// call the functions.
class ReadFailure {
public:
    /// The first sentence counts.
    void note(const std::string& sentence);
    bool is_noted() const { return is_noted_; }
    std::string sentence() const;

private:
    mutable std::mutex mutex_;
    std::string sentence_;
    std::atomic<bool> is_noted_{false};
};

/// A picture that the cache may open, as the caller of ovc_textures_api::open() names it.
struct NamedPicture {
    std::string file;
    std::span<const unsigned char> bytes; // instead of the file's; empty: they are in the file
    double gamma = 0;                     // 0: sRGB's curve
    std::shared_ptr<ReadFailure> failure; // not null
};

/// Notes the picture, and returns the name by which make_linear_input() opens it. Any number of
/// threads may call this and the next two.
std::string name_picture(const NamedPicture& picture);

/// Forgets the picture. Inputs that are open must be gone.
void forget_picture(const std::string& name);

/// Makes an input that opens pictures by such names. Its signature is that of
/// OIIO::ImageInput::Creator.
OIIO::ImageInput* make_linear_input();

} // namespace ovc
