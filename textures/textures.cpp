// SPDX-License-Identifier: Apache-2.0
// The functions of overcast_textures.h over OpenImageIO's texture system. No exception leaves them.
#include "textures/linear_input.h"
#include "textures/overcast_textures.h"

#include <OpenImageIO/imagecache.h>
#include <OpenImageIO/texture.h>

#include <algorithm>
#include <deque>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <stdexcept>

struct ovc_textures_ {
    struct OpenPicture {
        std::string name; // in the cache
        std::shared_ptr<ovc::ReadFailure> failure;
        OIIO::TextureSystem::TextureHandle* handle = nullptr;
        int channels = 0;
    };

    std::shared_mutex mutex; // of the pictures, which stay where they are while others are added
    std::deque<OpenPicture> pictures;
    OIIO::ImageCache* cache = nullptr;
    OIIO::TextureSystem* system = nullptr;
};

namespace {

using OpenPicture = ovc_textures_::OpenPicture;
using OIIO::ImageCache;
using OIIO::TextureOpt;
using OIIO::TextureSystem;

thread_local std::string last_error_text;

/// Calls the function; returns 0 and notes the sentence where it throws.
template <class Function>
int guarded(const Function& function) {
    try {
        function();
        return 1;
    } catch (const std::exception& e) {
        last_error_text = e.what();
    } catch (...) {
        last_error_text = "an unknown error";
    }
    return 0;
}

/// OpenImageIO's messages have several lines and repeat the name that we gave the picture.
std::string first_line(const std::string& message, const std::string& name) {
    std::string line = message.substr(0, message.find('\n'));
    for (size_t at; (at = line.find("\"" + name + "\": ")) != line.npos;)
        line.erase(at, name.size() + 4);
    for (size_t at; (at = line.find(name)) != line.npos;)
        line.erase(at, name.size());
    return line.empty() ? "its contents are no picture" : line;
}

/// Sets the errors of OpenImageIO aside, which would otherwise come up later.
template <class Source>
std::string error_of(Source& source, const std::string& name) {
    return first_line(source.has_error() ? source.geterror() : std::string(), name);
}

TextureOpt::Wrap wrap_of(uint32_t wrap) {
    switch (wrap) {
    case OVC_WRAP_CLAMP:
        return TextureOpt::WrapClamp;
    case OVC_WRAP_MIRROR:
        return TextureOpt::WrapMirror;
    case OVC_WRAP_BLACK:
        return TextureOpt::WrapBlack;
    default:
        return TextureOpt::WrapPeriodic;
    }
}

void destroy(ovc_textures textures) {
    guarded([&] {
        if (textures->system)
            TextureSystem::destroy(textures->system);
        if (textures->cache)
            ImageCache::destroy(textures->cache);
        for (const OpenPicture& picture : textures->pictures)
            ovc::forget_picture(picture.name);
    });
    delete textures;
}

ovc_textures create(uint64_t memory_bytes) {
    ovc_textures made = nullptr;
    const bool done = guarded([&] {
        made = new ovc_textures_;
        made->cache = ImageCache::create(/* shared= */ false);
        made->system = TextureSystem::create(/* shared= */ false, made->cache);
        made->cache->attribute("max_memory_MB",
                               float(double(memory_bytes) / (1 << 20))); // it takes 10 at least
    });
    if (!done && made)
        destroy(made);
    return done ? made : nullptr;
}

/// Returns the spec of the picture; throws a sentence where it cannot be read.
OIIO::ImageSpec spec_of(ovc_textures textures, const OpenPicture& picture) {
    const OIIO::ustring name(picture.name);
    textures->cache->add_file(name, ovc::make_linear_input);
    OIIO::ImageSpec spec;
    if (!textures->cache->get_imagespec(name, spec))
        throw std::runtime_error(error_of(*textures->cache, picture.name));
    return spec;
}

int open(ovc_textures textures, ovc_picture* picture, uint32_t* number) {
    return guarded([&] {
        if (!picture->bytes && !std::filesystem::exists(picture->file))
            throw std::runtime_error("there is no such file");
        // A pipe or a device may never end.
        if (!picture->bytes && !std::filesystem::is_regular_file(picture->file))
            throw std::runtime_error("it is no regular file");
        const auto* bytes = static_cast<const unsigned char*>(picture->bytes);
        OpenPicture opened;
        opened.failure = std::make_shared<ovc::ReadFailure>();
        opened.name = ovc::name_picture({picture->file,
                                         {bytes, bytes ? picture->byte_count : 0},
                                         picture->gamma,
                                         opened.failure});
        const OIIO::ImageSpec spec = spec_of(textures, opened);
        opened.channels = spec.nchannels;
        opened.handle = textures->system->get_texture_handle(OIIO::ustring(opened.name));
        if (!opened.handle || !textures->system->good(opened.handle))
            throw std::runtime_error(error_of(*textures->system, opened.name));
        picture->width = uint32_t(spec.width);
        picture->height = uint32_t(spec.height);
        picture->has_opacity = spec.nchannels % 2 == 0 ? 1 : 0;
        const std::scoped_lock lock(textures->mutex);
        *number = uint32_t(textures->pictures.size());
        textures->pictures.push_back(std::move(opened));
    });
}

/// Makes red, green, blue and opacity of what the picture's channels hold.
void spread_channels(int channels, float rgba[4]) {
    if (channels >= 4)
        return;
    const float opacity = channels == 2 ? rgba[1] : 1;
    if (channels < 3)
        rgba[1] = rgba[2] = rgba[0];
    rgba[3] = opacity;
}

const OpenPicture& picture_of(ovc_textures textures, uint32_t number) {
    const std::shared_lock lock(textures->mutex);
    return textures->pictures[number];
}

int sample(ovc_textures textures, uint32_t number, const ovc_texture_area* area, float rgba[4]) {
    return guarded([&] {
        const OpenPicture& picture = picture_of(textures, number);
        TextureOpt options;
        options.swrap = wrap_of(area->wrap_s);
        options.twrap = wrap_of(area->wrap_t);
        options.interpmode = area->texels == OVC_TEXELS_NEAREST ? TextureOpt::InterpClosest
                                                                : TextureOpt::InterpBilinear;
        options.mipmode = area->texels == OVC_TEXELS_MIPMAPS ? TextureOpt::MipModeAniso
                                                             : TextureOpt::MipModeNoMIP;
        const int channels = std::min(picture.channels, 4);
        // OpenImageIO's t grows downwards.
        if (!textures->system->texture(picture.handle, textures->system->get_perthread_info(),
                                       options, area->s, 1 - area->t, area->a[0], -area->a[1],
                                       area->b[0], -area->b[1], channels, rgba))
            throw std::runtime_error(error_of(*textures->system, picture.name));
        if (picture.failure->is_noted())
            throw std::runtime_error(first_line(picture.failure->sentence(), picture.name));
        spread_channels(channels, rgba);
        const bool is_beyond = (area->wrap_s == OVC_WRAP_BLACK && (area->s < 0 || area->s > 1)) ||
                               (area->wrap_t == OVC_WRAP_BLACK && (area->t < 0 || area->t > 1));
        if (is_beyond && channels % 2 == 1) // no channel says that nothing is there
            rgba[3] = 0;
    });
}

const char* last_error() {
    return last_error_text.c_str();
}

uint64_t memory_used(ovc_textures textures) {
    long long bytes = 0;
    guarded([&] {
        textures->cache->getattribute("stat:cache_memory_used", OIIO::TypeDesc::INT64, &bytes);
    });
    return uint64_t(bytes);
}

constexpr ovc_textures_api kApi{sizeof(ovc_textures_api),
                                OVC_TEXTURES_VERSION,
                                create,
                                destroy,
                                open,
                                sample,
                                last_error,
                                memory_used};

} // namespace

extern "C" __attribute__((visibility("default"))) const ovc_textures_api*
ovc_get_textures(uint32_t version) {
    return version == OVC_TEXTURES_VERSION ? &kApi : nullptr;
}
