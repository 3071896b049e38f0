// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene_pictures.h"

#include "core/file/checksum.h"
#include "core/text/printable.h"
#include "host/backend/plugin_loader.h"
#include "importers/file/text.h"
#include "textures/overcast_textures.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <filesystem>
#include <map>
#include <mutex>
#include <tuple>

namespace ovc {

namespace {

static_assert(uint32_t(Beyond::Repeat) == OVC_WRAP_REPEAT);
static_assert(uint32_t(Beyond::Clamp) == OVC_WRAP_CLAMP);
static_assert(uint32_t(Beyond::Mirror) == OVC_WRAP_MIRROR);
static_assert(uint32_t(Beyond::Nothing) == OVC_WRAP_BLACK);
static_assert(uint32_t(TexelFilter::Nearest) == OVC_TEXELS_NEAREST);
static_assert(uint32_t(TexelFilter::Smooth) == OVC_TEXELS_SMOOTH);
static_assert(uint32_t(TexelFilter::Mipmaps) == OVC_TEXELS_MIPMAPS);

constexpr const char* kMissing = "pictures that are missing or cannot be read";
constexpr const char* kNoLibrary = "pictures, for libovercast-textures.so is missing";

} // namespace

/// A picture that is open.
class ScenePictures::OpenedPicture final : public ImageLookup {
public:
    OpenedPicture(const ovc_textures_api& api, ovc_textures textures, uint32_t number,
                  const ovc_picture& picture)
        : api_(api),
          textures_(textures),
          number_(number),
          size_(picture.width, picture.height),
          has_opacity_(picture.has_opacity != 0) {}

    vec4 color(const PictureArea& area) const override {
        ovc_texture_area asked{float(area.st.x),
                               float(area.st.y),
                               {float(area.side_a.x), float(area.side_a.y)},
                               {float(area.side_b.x), float(area.side_b.y)},
                               uint32_t(area.beyond_s),
                               uint32_t(area.beyond_t),
                               uint32_t(area.filter)};
        keep_near(area, asked);
        float rgba[4];
        if (api_.sample(textures_, number_, &asked, rgba))
            return {rgba[0], rgba[1], rgba[2], rgba[3]};
        const std::scoped_lock lock(mutex_);
        if (failure_.empty())
            failure_ = api_.last_error();
        return {0.5f, 0.5f, 0.5f, 1};
    }

    dvec2 size() const override { return size_; }
    bool has_opacity() const override { return has_opacity_; }

    /// Returns why it could not be read somewhere; empty: it could everywhere.
    std::string failure() const {
        const std::scoped_lock lock(mutex_);
        return failure_;
    }

private:
    /// Floats far from 0 cannot tell texels apart, so a repeated picture is asked near 0. Doubles
    /// are shortened here, where their whole part says nothing any more.
    static void keep_near(const PictureArea& area, ovc_texture_area& asked) {
        const auto near = [](double x, Beyond beyond) {
            if (beyond == Beyond::Repeat)
                return float(x - std::floor(x));
            return beyond == Beyond::Mirror ? float(x - 2 * std::floor(0.5 * x)) : float(x);
        };
        asked.s = near(area.st.x, area.beyond_s);
        asked.t = near(area.st.y, area.beyond_t);
    }

    const ovc_textures_api& api_;
    const ovc_textures textures_;
    const uint32_t number_;
    const dvec2 size_;
    const bool has_opacity_;
    mutable std::mutex mutex_;
    mutable std::string failure_;
};

/// A picture whose colors are divided by a measure of itself (ImageTexture::per).
class ScenePictures::PicturePerMeasure final : public ImageLookup {
public:
    /// The picture must outlive it.
    PicturePerMeasure(const ImageLookup& picture, double measure)
        : picture_(picture), factor_(measure > 0 ? float(1 / measure) : 0) {}

    vec4 color(const PictureArea& area) const override {
        const vec4 found = picture_.color(area);
        return {factor_ * vec3(found), found.w};
    }
    dvec2 size() const override { return picture_.size(); }
    bool has_opacity() const override { return picture_.has_opacity(); }

private:
    const ImageLookup& picture_;
    const float factor_; // 0 of a black picture
};

namespace {

Result<const ovc_textures_api*> load_textures(const std::string& name) {
    const std::string path = find_plugin(name);
    void* const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (!library)
        return Error{dlerror()};
    const auto get =
        reinterpret_cast<ovc_get_textures_function>(dlsym(library, "ovc_get_textures"));
    const ovc_textures_api* const api = get ? get(OVC_TEXTURES_VERSION) : nullptr;
    if (!api || api->struct_size < sizeof(ovc_textures_api))
        return Error{fmt::format("'{}' is of another version", path)};
    return api;
}

/// Returns the sentence about a picture, which begins with the place that names it.
std::string sentence_about(const PictureFile& picture, const std::string& what) {
    return fmt::format("{}{}the picture '{}' is not shown: {}", picture.asked_for_at,
                       picture.asked_for_at.empty() ? "" : ": ", printable(picture.file),
                       printable(what));
}

} // namespace

struct ScenePictures::Opened {
    using Key = std::tuple<std::string, uint64_t, double>; // file, checksum of its contents, gamma
    struct Picture {
        PictureFile file; // whose contents the library uses
        std::unique_ptr<OpenedPicture> lookup;
        std::string why_not; // the sentence, where it is null
        bool has_failed = false;
    };

    const ovc_textures_api* api = nullptr; // null: the library is missing
    ovc_textures textures = nullptr;
    std::map<Key, Picture> pictures;
    /// By the picture, the measure and its channel and window: each costs a look at every texel.
    using MeasureKey =
        std::tuple<const ImageLookup*, ImageTexture::Measure, ImageTexture::Channel, double>;
    std::map<MeasureKey, PicturePerMeasure> by_measure;

    Opened() = default;
    Opened(const Opened&) = delete;
    ~Opened() {
        if (textures)
            api->destroy(textures);
    }

    /// Opens a picture, unless it is open.
    Picture& open(const PictureFile& file, double gamma) {
        Checksum sum;
        sum.add(std::as_bytes(std::span(file.contents)));
        const auto [at, is_new] = pictures.try_emplace(Key{file.file, sum.value(), gamma});
        Picture& picture = at->second;
        if (!is_new)
            return picture;
        picture.file = file;
        ovc_picture asked{
            sizeof(ovc_picture), picture.file.file.c_str(), nullptr, 0, gamma, 0, 0, 0};
        if (!file.contents.empty()) {
            asked.bytes = picture.file.contents.data();
            asked.byte_count = picture.file.contents.size();
        }
        uint32_t number = 0;
        if (api->open(textures, &asked, &number))
            picture.lookup = std::make_unique<OpenedPicture>(*api, textures, number, asked);
        else
            picture.why_not = sentence_about(file, api->last_error());
        return picture;
    }

    /// Gives an image its picture, or that divided by its measure.
    void look_up(const ImageLookup* picture, ImageTexture& image) {
        image.lookup = picture;
        if (!picture || image.per == ImageTexture::Measure::None)
            return;
        const MeasureKey key{picture, image.per, image.channel, image.window_distance};
        auto at = by_measure.find(key);
        if (at == by_measure.end())
            at = by_measure.try_emplace(key, *picture, measured(image)).first;
        image.lookup = &at->second;
    }
};

bool ScenePictures::library_is_there() {
    std::error_code ignored;
    return std::filesystem::exists(find_plugin(kTextureLibrary), ignored);
}

ScenePictures::ScenePictures(PictureOptions options, LogSink log)
    : options_(std::move(options)), log_(std::move(log)) {}

ScenePictures::~ScenePictures() = default;

Result<Done> ScenePictures::leave_out(Scene& scene, const std::string& sentence,
                                      const char* kind) const {
    if (options_.strict)
        return Error{sentence};
    say(log_, LogLevel::Warning, sentence);
    for (Omission& omission : scene.omissions)
        if (omission.sentence == kind) {
            ++omission.count;
            return Done{};
        }
    scene.omissions.push_back({kind, 1});
    return Done{};
}

Result<Done> ScenePictures::open_library() {
    opened_ = std::make_unique<Opened>();
    const Result<const ovc_textures_api*> api = load_textures(options_.library);
    if (!api)
        return api.error();
    opened_->api = *api;
    opened_->textures = (*api)->create(options_.memory_bytes);
    return opened_->textures ? Result<Done>(Done{}) : Error{(*api)->last_error()};
}

Result<Done> ScenePictures::open(Scene& scene) {
    if (scene.pictures.empty())
        return Done{};
    if (!opened_)
        if (const Result<Done> done = open_library(); !done) {
            const std::string sentence = fmt::format(
                "{}: its {} are not shown, only colors that stand for them: {}; Overcast has this "
                "library where it is built with Debian's libopenimageio-dev",
                scene.name, counted(scene.pictures.size(), "picture"), done.error().message);
            if (const Result<Done> fine = leave_out(scene, sentence, kNoLibrary); !fine)
                return fine;
            scene.omissions.back().count = scene.pictures.size();
        }
    if (!opened_->textures)
        return Done{};
    for (Texture& texture : scene.textures) {
        if (!texture.image)
            continue;
        assert(texture.image->picture < scene.pictures.size());
        Opened::Picture& picture =
            opened_->open(scene.pictures[texture.image->picture], texture.image->gamma);
        opened_->look_up(picture.lookup.get(), *texture.image);
        if (picture.lookup || picture.has_failed)
            continue;
        picture.has_failed = true;
        if (const Result<Done> fine = leave_out(scene, picture.why_not, kMissing); !fine)
            return fine;
    }
    return Done{};
}

Result<Done> ScenePictures::check(Scene& scene) {
    if (!opened_)
        return Done{};
    for (auto& [key, picture] : opened_->pictures) {
        if (!picture.lookup || picture.has_failed || picture.lookup->failure().empty())
            continue;
        picture.has_failed = true;
        if (const Result<Done> fine =
                leave_out(scene, sentence_about(picture.file, picture.lookup->failure()), kMissing);
            !fine)
            return fine;
    }
    return Done{};
}

} // namespace ovc
