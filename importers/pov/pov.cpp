// SPDX-License-Identifier: Apache-2.0
// The POV-Ray reader: reads the statements of a scene and turns a ParseError into an Error.
// docs/reference/pov.md says what is read.
#include "importers/file/text.h"
#include "importers/pov/flatten.h"
#include "importers/pov/material_table.h"
#include "importers/pov/parse/parse_camera.h"
#include "importers/pov/parse/parse_media.h"
#include "importers/pov/parse/parse_object.h"
#include "importers/pov/parse/parse_sky.h"
#include "importers/pov/parse/parse_value.h"
#include "importers/pov/parse/texture.h"
#include "importers/pov/texture_table.h"
#include "importers/pov/words/block.h"
#include "importers/pov/words/files.h"
#include "importers/readers.h"

#include <fmt/format.h>

#include <algorithm>

namespace ovc::pov {

namespace {

/// Reads the { texture { … } pigment { … } finish { … } } of #default.
void parse_defaults(Reader& reader) {
    reader.expect('{', "#default");
    while (!reader.take('}')) {
        if (reader.take("texture"))
            reader.defaults = parse_texture(reader);
        else if (reader.take("pigment"))
            reader.defaults.pigment = parse_pigment(reader, reader.defaults.pigment);
        else if (reader.take("finish"))
            reader.defaults.surface = parse_finish(reader, reader.defaults.surface);
        else if (reader.take("normal"))
            reader.defaults.normal = parse_normal(reader, reader.defaults.normal);
        else if (reader.take("camera") || reader.take("radiosity"))
            skip_braces(reader, "#default");
        else
            reader.fail_here("a texture, pigment or finish");
    }
    reader.shared_defaults = std::make_shared<const Texture>(reader.defaults);
}

/// Reads radiosity { } from its { on. Words that say how exactly povray is to compute it are
/// skipped.
Radiosity parse_radiosity(Reader& reader) {
    Radiosity radiosity;
    reader.expect('{', "radiosity");
    while (!reader.take('}')) {
        if (reader.take("recursion_limit"))
            radiosity.bounces = uint32_t(parse_int(reader, 1, 20, "recursion_limit"));
        else if (reader.take("brightness"))
            radiosity.brightness = std::max(0.0f, float(parse_float(reader)));
        else if (!take_skipped(reader, {"adc_bailout", "always_sample", "count", "error_bound",
                                        "gray_threshold", "load_file", "low_error_factor",
                                        "max_sample", "maximum_reuse", "media", "minimum_reuse",
                                        "nearest_count", "normal", "pretrace_end", "pretrace_start",
                                        "save_file", "subsurface"}) &&
                 !reader.take(','))
            reader.fail_here("a part of radiosity");
    }
    return radiosity;
}

Texture factory_default() {
    Texture texture;
    texture.surface.finish.diffuse = 0.6f;
    return texture;
}

class SceneParser {
public:
    SceneParser(const ImportOptions& options, const std::string& folder, uint64_t max_words)
        : options_(options),
          reader_({parse_value, parse_float, parse_condition, parse_item, parse_defaults},
                  options.log, folder, options.files) {
        reader_.limits.tokens = max_words;
        reader_.limits.triangles = options.max_triangles;
        reader_.defaults = factory_default();
        reader_.shared_defaults = std::make_shared<const Texture>(reader_.defaults);
        reader_.version = options.pov_version.value_or(reader_.version);
        reader_.version_given = options.pov_version.has_value();
        reader_.picture = options.size.value_or(reader_.picture);
        reader_.moment = options.moment;
        reader_.strict = options.strict;
    }

    Scene parse(std::unique_ptr<SourceFile> file) {
        Scene scene;
        scene.background = {vec3(0), vec3(0)}; // POV-Ray's default
        scene.may_add_light = false;           // a scene without lights has ambient and emission
        reader_.open(std::move(file));
        while (reader_.peek().kind != TokenKind::End)
            parse_statement(scene);
        scene.max_depth = trace_level_ - 1; // POV-Ray counts the camera's rays too
        // Before 3.7 scenes made colors for screens, and povray still writes them as they are.
        scene.gamma = gamma_given_ || reader_.has_linear_colors() ? reader_.gamma : kSrgbGamma;
        camera_ = camera_.value_or(CameraValue{});
        scene.camera = camera_of(*camera_);
        scene.size = options_.size.value_or(size_of(*camera_));
        look_.eye = camera_->location;
        look_.max_triangles = options_.max_triangles;
        look_.tolerance = options_.tolerance;
        look_.tell = [&](const Note& note) { reader_.omit(note.kind, note.place, note.sentence); };
        look_.before_3_7 = !reader_.has_linear_colors();
        look_.irid_noise = reader_.noise_kind();
        look_.has_media = reader_.has_media;
        scene.background.tints = !look_.before_3_7;
        if (scene.radiosity && !look_.before_3_7)
            look_.ambient_light = vec3(0); // as povray since 3.7
        take_rays(*camera_, scene);
        if (camera_->normal.pattern.pattern)
            scene.camera->bump = MaterialTable(look_, scene).bump(camera_->normal, dmat4(1));
        if (sky_)
            add_sky(*sky_, look_, scene);
        for (const Media& media : air_)
            scene.background.media.push_back(MaterialTable(look_, scene).medium(media, dmat4(1)));
        flatten(objects_, look_, scene);
        scene.moves = reader_.moves;
        scene.omissions = reader_.omissions();
        return scene;
    }

private:
    void draw(ObjectPtr object) {
        objects_.push_back({std::move(object), reader_.shared_defaults});
    }

    void parse_statement(Scene& scene) {
        const Token token = reader_.peek();
        if (starts_object(token))
            draw(parse_object(reader_));
        else if (reader_.take("camera"))
            camera_ = parse_camera(reader_);
        else if (reader_.take("background"))
            parse_background(scene);
        else if (reader_.take("global_settings"))
            parse_settings(scene);
        else if (reader_.take("sky_sphere"))
            sky_ = parse_sky_sphere(reader_);
        else if (reader_.take("fog")) {
            if (const Fog fog = parse_fog(reader_); fog.distance > 0)
                scene.background.fogs.push_back(fog); // as povray, which draws none of no distance
        } else if (reader_.take("radiosity")) {       // as before 3.5
            scene.radiosity = parse_radiosity(reader_);
        } else if (reader_.take("media")) {
            air_.push_back(parse_media(reader_));
        } else if (reader_.take("rainbow")) {
            add_rainbow(parse_rainbow(reader_), scene);
        } else if (token.is("photons")) {
            reader_.next();
            reader_.omit(token.name->text, token.place, token.name->text + " is left out");
            skip_braces(reader_, token.name->text);
        } else if (auto object = take_named_if<ObjectPtr>(reader_))
            draw(std::move(*object));
        else if (const auto camera = take_named_if<CameraValue>(reader_))
            camera_ = *camera;
        else if (!reader_.take(';')) {
            reader_.next();
            const bool is_undeclared = token.kind == TokenKind::Name && !token.name->is_keyword &&
                                       !reader_.find(token.name);
            reader_.fail(token.place,
                         fmt::format("found {}{}, expected an object or a statement "
                                     "such as camera",
                                     found(token), is_undeclared ? ", which is not declared" : ""));
        }
    }

    /// Gives the scene the faces of its camera, and the number of rays that camera takes a pixel.
    static void take_rays(const CameraValue& camera, Scene& scene) {
        if (scene.camera->lens)
            scene.samples = camera.blur_samples;
        if (!camera.faces)
            return;
        scene.samples = camera.face_rays;
        scene.faces = *camera.faces;
        scene.faces->ahead = camera.location.z;
        scene.faces->backwards = camera.direction.z < 0;
    }

    /// povray draws none without colors either.
    static void add_rainbow(Rainbow bow, Scene& scene) {
        const double length = glm::length(bow.direction);
        if (bow.colors.empty() || !(bow.width > 0 && bow.distance > 0 && bow.arc > 0 && length > 0))
            return;
        bow.direction /= length;
        scene.background.rainbows.push_back(std::move(bow));
    }

    void parse_background(Scene& scene) {
        reader_.expect('{', "background");
        const Color color = parse_color(reader_);
        const bool shows_black = reader_.version >= 3.7; // behind what the color lets through
        scene.background.horizon = scene.background.zenith =
            (shows_black ? 1 - color.transmit : 1) * color.rgb;
        reader_.expect('}', "background");
    }

    void parse_settings(Scene& scene) {
        reader_.expect('{', "global_settings");
        while (!reader_.take('}')) {
            if (reader_.take("assumed_gamma")) {
                reader_.gamma =
                    reader_.take("srgb") ? kSrgbGamma : std::clamp(parse_float(reader_), 0.1, 10.0);
                gamma_given_ = true;
            } else if (reader_.take("max_trace_level"))
                trace_level_ = uint32_t(parse_int(reader_, 1, 256, "max_trace_level"));
            else if (reader_.take("number_of_waves"))
                reader_.wave_sources = parse_int(reader_, 1, 1000, "number_of_waves");
            else if (reader_.take("noise_generator"))
                reader_.noise = NoiseKind(parse_int(reader_, 1, 3, "noise_generator"));
            else if (reader_.take("ambient_light"))
                look_.ambient_light = parse_color(reader_).rgb;
            else if (reader_.take("irid_wavelength"))
                look_.irid_wavelengths = glm::max(parse_color(reader_).rgb, vec3(1e-6f));
            else if (reader_.take("radiosity"))
                scene.radiosity = parse_radiosity(reader_);
            else if (reader_.take("charset"))
                reader_.next(); // ascii, utf8 or sys: texts are taken as UTF-8
            else if (const Token token = reader_.peek();
                     take_skipped(reader_, {"hf_gray_16", "photons", "subsurface"}))
                reader_.omit(token.name->text, token.place, token.name->text + " is left out");
            else if (!take_skipped(reader_, {"adc_bailout", "max_intersections", "mm_per_unit"}))
                reader_.fail_here("a part of global_settings");
        }
    }

    /// Returns a size of 480 rows that has the proportions of the camera's window.
    ImageSize size_of(const CameraValue& camera) const {
        if (!camera.window_given)
            return {640, 480};
        const double high = glm::length(camera.up), wide = glm::length(camera.right);
        const double ratio = high > 0 && wide > 0 ? std::clamp(wide / high, 0.1, 10.0) : 4 / 3.0;
        return {uint32_t(std::lround(480 * ratio)), 480};
    }

    const ImportOptions& options_;
    Reader reader_;
    Look look_;
    std::optional<SkySphere> sky_;
    std::vector<Media> air_; // of the whole scene
    bool gamma_given_ = false;
    uint32_t trace_level_ = 5;
    std::vector<DrawnObject> objects_;
    std::optional<CameraValue> camera_;
};

std::string text_of(const Place& place) {
    return fmt::format("{}:{}:{}", place.file->name, place.line, place.column);
}

/// Returns the excerpt at the place, which starts on a new line.
std::string line_of(const Place& place) {
    const std::string shown = excerpt(place);
    return shown.empty() ? "" : "\n" + shown;
}

/// Returns "FILE:LINE:COLUMN: sentence" and the line, then the line of the scene's own file that
/// called or included it.
Error error_of(const ParseError& error, const std::string& scene) {
    if (!error.place.file)
        return {fmt::format("{}: {}", scene, error.what())};
    std::string message =
        fmt::format("{}: {}{}", text_of(error.place), error.what(), line_of(error.place));
    if (const Caller& caller = error.caller; caller.place.file)
        message += fmt::format("\n    {} at {}:{}", caller.is_macro ? "called" : "included",
                               text_of(caller.place), line_of(caller.place));
    return {message};
}

} // namespace

} // namespace ovc::pov

namespace ovc {

Result<Scene> read_pov(const std::filesystem::path& path, const ImportOptions& options) {
    Result<std::string> text = pov::read_text(path, options.files);
    if (!text)
        return text.error();
    return parse_pov(std::move(*text), path, options);
}

Result<Scene> parse_pov(std::string text, const std::filesystem::path& path,
                        const ImportOptions& options, uint64_t max_words) {
    auto file = std::make_unique<pov::SourceFile>();
    file->name = path.string();
    file->folder = path.parent_path().string();
    file->text = std::move(text);
    pov::SceneParser parser(options, file->folder, max_words);
    try {
        Scene scene = parser.parse(std::move(file));
        scene.name = path.stem().string();
        if (scene.soup.triangle_count() == 0)
            say(options.log, LogLevel::Warning,
                fmt::format("{}: it has no triangles", path.string()));
        return scene;
    } catch (const pov::ParseError& error) {
        return pov::error_of(error, path.string());
    }
}

} // namespace ovc
