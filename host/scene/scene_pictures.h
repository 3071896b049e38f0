// SPDX-License-Identifier: Apache-2.0
// ScenePictures opens the pictures of a scene's textures by libovercast-textures.so. That library
// is loaded for the first scene that has pictures, and nothing else needs it.
#pragma once

#include "core/result.h"
#include "core/scene.h"
#include "core/system/log.h"

#include <cstdint>
#include <memory>
#include <string>

namespace ovc {

inline constexpr const char* kTextureLibrary = "libovercast-textures.so";

/// The default of --texture-memory.
inline constexpr uint64_t kDefaultTextureMemory = uint64_t(256) << 20;

struct PictureOptions {
    uint64_t memory_bytes = kDefaultTextureMemory; // for texels
    bool strict = false; // a picture that is missing or cannot be read is an error
    std::string library = kTextureLibrary;
};

class ScenePictures {
public:
    /// Returns whether the library lies where open() looks for it. It is not loaded.
    static bool library_is_there();

    ScenePictures(PictureOptions options, LogSink log);
    ~ScenePictures();
    ScenePictures(const ScenePictures&) = delete;

    /// Gives the textures of the scene their pictures, which live as long as this. Warns of each
    /// that cannot be opened, or once if the library is missing, and counts those among the scene's
    /// omissions; textures then keep the colors that stand for them. It may be called again for
    /// other moments of the scene. Error: with `strict`, the first such sentence.
    Result<Done> open(Scene& scene);

    /// Warns of pictures that could be opened but not read where they were looked at, and counts
    /// them among the omissions. Error: as above.
    Result<Done> check(Scene& scene);

private:
    class OpenedPicture;
    class PicturePerMeasure;
    struct Opened;

    Result<Done> leave_out(Scene& scene, const std::string& sentence, const char* kind) const;
    Result<Done> open_library();

    const PictureOptions options_;
    const LogSink log_;
    std::unique_ptr<Opened> opened_; // null until there is a picture
};

} // namespace ovc
