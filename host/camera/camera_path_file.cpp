// SPDX-License-Identifier: Apache-2.0
// Reads both formats of camera paths. The first character that is not blank tells them apart: JSON
// begins with a bracket or a brace.
#include "host/camera/camera_path_file.h"

#include "host/arguments/arguments.h"
#include "host/camera/camera.h"
#include "importers/file/source.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <optional>

namespace ovc {

/// The parser drops values that lie deeper than cameras[7].eye[2]; no camera has any there.
static constexpr int kDeepest = 4;

static std::optional<dvec3> point_of(const nlohmann::json& value) {
    if (!value.is_array() || value.size() != 3)
        return std::nullopt;
    dvec3 point;
    for (int axis = 0; axis < 3; ++axis) {
        if (!value[size_t(axis)].is_number())
            return std::nullopt;
        point[axis] = value[size_t(axis)].get<double>();
    }
    return point;
}

/// Reads the point called `key` into `to`. Without such a point, `to` stays; it is an error if the
/// point is needed.
static Result<Done> read_point(const nlohmann::json& camera, const char* key, bool needed,
                               dvec3& to) {
    const auto found = camera.find(key);
    if (found == camera.end()) {
        if (needed)
            return Error{fmt::format("it has no \"{}\"", key)};
        return Done{};
    }
    const std::optional<dvec3> point = point_of(*found);
    if (!point)
        return Error{fmt::format("its \"{}\" is not a list of three numbers", key)};
    to = *point;
    return Done{};
}

static Result<Camera> json_camera(const nlohmann::json& value) {
    if (!value.is_object())
        return Error{"it is not an object with \"eye\" and \"target\""};
    Camera camera;
    for (const auto& [key, ignored] : value.items())
        if (key != "eye" && key != "target" && key != "up" && key != "fov")
            return Error{fmt::format("there is no \"{}\" in a camera", key)};
    if (const Result<Done> fine = read_point(value, "eye", true, camera.eye); !fine)
        return fine.error();
    if (const Result<Done> fine = read_point(value, "target", true, camera.target); !fine)
        return fine.error();
    if (const Result<Done> fine = read_point(value, "up", false, camera.up); !fine)
        return fine.error();
    if (const auto fov = value.find("fov"); fov != value.end()) {
        if (!fov->is_number())
            return Error{"its \"fov\" is not a number"};
        camera.fov_degrees = fov->get<double>();
    }
    if (camera.up == dvec3(0))
        return Error{"its \"up\" has no direction"};
    if (const Result<Done> fine = check_camera(camera); !fine)
        return fine.error();
    return camera;
}

static Result<CameraPath> parse_json(const std::string& name, const std::string& text) {
    const auto shallow = [](int depth, nlohmann::json::parse_event_t, nlohmann::json&) {
        return depth <= kDeepest;
    };
    nlohmann::json document;
    try {
        document = nlohmann::json::parse(text, shallow);
    } catch (const nlohmann::json::parse_error& error) {
        return Error{fmt::format("{}, byte {}: this is not JSON", name, error.byte)};
    } catch (const nlohmann::json::out_of_range&) {
        return Error{fmt::format("{}: a number in it is too large", name)};
    }
    const nlohmann::json& cameras =
        document.is_object() && document.contains("cameras") ? document["cameras"] : document;
    if (!cameras.is_array())
        return Error{
            fmt::format("{}: expected a list of cameras, or {{\"cameras\": [...]}}", name)};
    CameraPath path;
    for (const nlohmann::json& value : cameras) {
        if (path.size() == kMaxFrames)
            return Error{fmt::format("{}: more than {} cameras", name, kMaxFrames)};
        const Result<Camera> camera = json_camera(value);
        if (!camera)
            return Error{
                fmt::format("{}, camera {}: {}", name, path.size(), camera.error().message)};
        path.push_back(*camera);
    }
    return path;
}

static std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kWhite = " \t\r\v\f";
    text.remove_prefix(std::min(text.find_first_not_of(kWhite), text.size()));
    return text.substr(0, text.find_last_not_of(kWhite) + 1);
}

static bool is_header(std::string_view line) {
    return line == "ex,ey,ez,tx,ty,tz" || line == "ex,ey,ez,tx,ty,tz,fov";
}

static Result<CameraPath> parse_lines(const std::string& name, std::string_view text) {
    CameraPath path;
    for (size_t at = 0, number = 1; at < text.size(); ++number) {
        const size_t end = std::min(text.find('\n', at), text.size());
        const std::string_view line = trimmed(text.substr(at, end - at));
        at = end + 1;
        if (line.empty() || line[0] == '#' || (path.empty() && is_header(line)))
            continue;
        if (path.size() == kMaxFrames)
            return Error{
                fmt::format("{}, line {}: more than {} cameras", name, number, kMaxFrames)};
        const Result<Camera> camera = parse_camera("a frame", line);
        if (!camera)
            return Error{fmt::format("{}, line {}: {}", name, number, camera.error().message)};
        path.push_back(*camera);
    }
    return path;
}

static Result<std::string> read_text(const std::filesystem::path& file) {
    Result<Source> source = Source::open(file);
    if (!source)
        return source.error();
    std::string text;
    while (const unsigned char* byte = source->bytes(1)) {
        if (text.size() == kMaxPathBytes)
            return Error{fmt::format("{}: more than {} MiB, too much for a camera path",
                                     file.string(), kMaxPathBytes >> 20)};
        text.push_back(char(*byte));
    }
    if (source->is_damaged())
        return source->error("damaged");
    return text;
}

Result<CameraPath> load_camera_path(const std::filesystem::path& file) {
    const Result<std::string> text = read_text(file);
    if (!text)
        return text.error();
    const size_t first = text->find_first_not_of(" \t\r\n");
    const bool json = first != text->npos && ((*text)[first] == '[' || (*text)[first] == '{');
    Result<CameraPath> path =
        json ? parse_json(file.string(), *text) : parse_lines(file.string(), *text);
    if (path && path->empty())
        return Error{fmt::format("{}: there is no camera in it", file.string())};
    return path;
}

} // namespace ovc
