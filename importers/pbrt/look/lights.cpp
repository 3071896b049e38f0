// SPDX-License-Identifier: Apache-2.0
// Point, spot and distant lights keep their kind, and pictures are thrown; the sky becomes a
// background and some light from above.
#include "importers/pbrt/look/lights.h"

#include "importers/file/text.h"
#include "importers/pbrt/look/area_lights.h"
#include "importers/pbrt/look/material_families.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

namespace ovc::pbrt {

namespace {

using std::numbers::pi;

/// Limited, because each light costs a shadow ray for every hit.
constexpr size_t kMaxAreaLights = 32;

/// The shares of a constant sky that surfaces reflect without shadows, and that comes from above
/// and casts some. An open surface would reflect all of it, but rooms see little.
constexpr float kSkyAmbient = 0.25f, kSkyFromAbove = 0.35f;

double cosine(double degrees) {
    return std::cos(degrees * (pi / 180));
}

/// Returns how much longer some ways become by a transform than others.
double stretch_of(const dmat4& m) {
    double longest = 0, shortest = 1e300;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
                if (const dvec3 way(x, y, z); way != dvec3(0)) {
                    const double length = glm::length(vector_through(m, way)) / glm::length(way);
                    longest = std::max(longest, length);
                    shortest = std::min(shortest, length);
                }
    return shortest > 0 ? longest / shortest : 1e300;
}

/// Returns whether v4's "power" or "illuminance" is stated.
bool asks_for(const Parameters& p, std::string_view name) {
    return p.number(name, -1) > 0;
}

/// Returns what v4's "power" or "illuminance" multiplies a light's color by. of_one: what a light
/// of color 1 gives. A color in rgb counts as it is, as in pbrt.
float factor_of(const Parameters& p, std::string_view name, double of_one) {
    return asks_for(p, name) ? float(p.number(name, -1) / of_one) : 1;
}

} // namespace

vec3 Lights::scaled(const Parameters& p, std::string_view color, const vec3& otherwise) const {
    const Parameter* const stated = p.find(color);
    const bool is_spectrum = textures_.is_v4() && stated && stated->kind == Kind::Spectrum;
    const std::optional<vec3> light = is_spectrum ? illuminant(*stated) : std::nullopt;
    // v2 and v3 scale by a color, v4 by a number.
    return (light ? *light : textures_.color(p, color, otherwise)) *
           textures_.color(p, "scale", vec3(1));
}

bool Lights::add(const std::string& type, const Parameters& parameters, const dmat4& to_world,
                 const Place& place) {
    any_ = true;
    if (type == "point")
        add_point(parameters, to_world);
    else if (type == "spot")
        add_spot(parameters, to_world, place);
    else if (type == "distant")
        add_distant(parameters, to_world, place);
    else if (type == "infinite" || type == "exinfinite")
        add_infinite(parameters, to_world, place);
    else if (type == "goniometric")
        add_goniometric(parameters, to_world, place);
    else if (type == "projection")
        add_projection(parameters, to_world, place);
    else {
        diagnostics_.missing("light " + type, place,
                             fmt::format("lights {} left out", ovc::quoted(type)));
        return false;
    }
    return true;
}

void Lights::add_point(const Parameters& p, const dmat4& to_world) {
    Light light;
    light.position = point_through(to_world, p.point("from", dvec3(0)));
    set_falloff(light, factor_of(p, "power", 4 * pi) * scaled(p, "I", vec3(1)));
    lights_.push_back(light);
}

/// Returns the name of the parameter with a light's picture: "filename" in v4, "mapname" before;
/// null where it has none.
static const char* picture_of(const Parameters& p) {
    return p.find("filename") ? "filename" : p.find("mapname") ? "mapname" : nullptr;
}

/// Returns how the picture lies around a sky or a lamp: v3's "mapname" goes around by longitudes
/// and latitudes, v4's "filename" is octahedral, its first row at t = 0.
static ImageTexture around(bool is_octahedral) {
    ImageTexture map;
    map.projection =
        is_octahedral ? ImageTexture::Projection::Octahedral : ImageTexture::Projection::LatLong;
    if (is_octahedral)
        map.to_picture = {dvec3(1, 0, 0), dvec3(0, -1, 1)};
    map.beyond_s = is_octahedral ? Beyond::Clamp : Beyond::Repeat;
    map.beyond_t = Beyond::Clamp;
    map.filter = is_octahedral ? TexelFilter::Nearest : TexelFilter::Smooth; // as in v4 and v3
    return map;
}

ThrownPicture Lights::thrown(const Parameters& p, const dmat3& to_light,
                             const ImageTexture& picture, const Place& place) {
    ThrownPicture thrown;
    thrown.texture.texture =
        textures_.image(p.text(picture_of(p)), place, picture, /* on_uv= */ false);
    for (int row = 0; row < 3; ++row)
        thrown.texture.to_texture[size_t(row)] =
            dvec4(to_light[0][row], to_light[1][row], to_light[2][row], 0);
    return thrown;
}

/// The picture's axis is that of y, so that y and z change places.
void Lights::add_goniometric(const Parameters& p, const dmat4& to_world, const Place& place) {
    add_point(p, to_world);
    if (!picture_of(p))
        return;
    const bool is_v4 = p.find("filename") != nullptr;
    ImageTexture picture = around(is_v4);
    picture.otherwise = {vec3(1)};
    if (is_v4) { // it has brightness alone there
        picture.channel = ImageTexture::Channel::Mean;
        if (asks_for(p, "power"))
            picture.per = ImageTexture::Measure::Mean;
    }
    const dmat3 upright(dvec3(1, 0, 0), dvec3(0, 0, 1), dvec3(0, 1, 0));
    lights_.back().thrown = thrown(p, upright * glm::inverse(dmat3(to_world)), picture, place);
}

/// "fov" is the angle of the shorter side of a window. The first row of v4's "filename" lies on its
/// upper edge, and that of v3's "mapname" on its lower one.
void Lights::add_projection(const Parameters& p, const dmat4& to_world, const Place& place) {
    if (!picture_of(p)) {
        diagnostics_.approximate("projection", place,
                                 "projection lights without a picture are spots");
        return add_spot(p, to_world, place);
    }
    add_point(p, to_world);
    const bool is_v4 = p.find("filename") != nullptr;
    ImageTexture picture;
    if (!is_v4)
        picture.to_picture = {dvec3(1, 0, 0), dvec3(0, -1, 1)};
    picture.beyond_s = picture.beyond_t = Beyond::Clamp;
    picture.filter = is_v4 ? TexelFilter::Nearest : TexelFilter::Smooth;
    picture.otherwise = {vec3(1)};
    const double angle = std::clamp(p.number("fov", is_v4 ? 90 : 45), 1e-3, 179.9);
    const double by_side = 1 / std::tan(angle * (pi / 360));
    if (asks_for(p, "power")) {
        lights_.back().color *= 4 * pi; // it shines through the window alone
        picture.per = ImageTexture::Measure::ThroughWindow;
        picture.window_distance = by_side;
    }
    const dmat3 to_window(dvec3(by_side, 0, 0), dvec3(0, by_side, 0), dvec3(0, 0, 1));
    lights_.back().thrown = thrown(p, to_window * glm::inverse(dmat3(to_world)), picture, place);
    lights_.back().thrown->has_window = true;
}

void Lights::tell_no_direction(const Place& place) {
    diagnostics_.missing("direction of a light", place,
                         "a light left out: its \"from\" and \"to\" make no direction");
}

void Lights::add_spot(const Parameters& p, const dmat4& to_world, const Place& place) {
    Light light;
    const dvec3 from = p.point("from", dvec3(0)), to = p.point("to", dvec3(0, 0, 1));
    light.position = point_through(to_world, from);
    const dvec3 direction = point_through(to_world, to) - light.position;
    if (!(glm::length(direction) > 0))
        return tell_no_direction(place);
    light.direction = glm::normalize(direction);
    const double angle = p.number("coneangle", p.number("fov", 30));
    const double soft = p.number("conedeltaangle", 5);
    light.cone = SpotCone{cosine(std::max(angle - soft, 0.0)), cosine(std::min(angle, 180.0)), 0};
    if (stretch_of(to_world) > 1.001)
        diagnostics_.approximate("stretched spot", place,
                                 "the cones of spots stay round where space is stretched");
    // pbrt takes half of the soft edge as lit.
    const double lit = 2 * pi * (1 - (cosine(angle - soft) + cosine(angle)) / 2);
    set_falloff(light, factor_of(p, "power", lit) * scaled(p, "I", vec3(1)));
    lights_.push_back(light);
}

void Lights::add_distant(const Parameters& p, const dmat4& to_world, const Place& place) {
    const dvec3 from = p.point("from", dvec3(0, 0, 0)), to = p.point("to", dvec3(0, 0, 1));
    const dvec3 direction = vector_through(to_world, to - from);
    if (!(glm::length(direction) > 0))
        return tell_no_direction(place);
    Light light;
    light.parallel = light.distant = true;
    light.direction = glm::normalize(direction);
    // The host divides it by pi, for the BRDF of a matte surface.
    light.color = factor_of(p, "illuminance", 1) * scaled(p, "L", vec3(1));
    lights_.push_back(light);
}

/// A map is a layer before a sky of even colors, which Whitted's model takes ambient light from.
void Lights::add_infinite(const Parameters& p, const dmat4& to_world, const Place& place) {
    if (p.find("portal"))
        diagnostics_.approximate("portal", place,
                                 "skies shine from all around, not only through their portals");
    const bool has_map = picture_of(p) != nullptr;
    const vec3 radiance = factor_of(p, "illuminance", pi) * scaled(p, "L", vec3(1));
    const Background colors; // the default sky, of luminance about 1/2 to 1
    if (!sky_)
        sky_ = Background{vec3(0), vec3(0)};
    sky_->horizon += radiance * (has_map ? colors.horizon : vec3(1));
    sky_->zenith += radiance * (has_map ? colors.zenith : vec3(1));
    ++skies_;
    if (has_map)
        add_map(p, radiance, to_world, place);
    else
        even_sky_ += radiance;
}

void Lights::add_map(const Parameters& p, const vec3& radiance, const dmat4& to_world,
                     const Place& place) {
    const bool is_octahedral = !p.find("mapname");
    ImageTexture map = around(is_octahedral);
    map.scale = radiance;
    if (asks_for(p, "illuminance")) { // pbrt counts each texel as half as large as it is
        map.scale *= float(2 * pi);
        map.per = ImageTexture::Measure::FromAbove;
    }
    map.otherwise = {vec3(0), 0, 1}; // the sky behind it is seen
    const uint32_t texture = textures_.image(p.text(is_octahedral ? "filename" : "mapname"), place,
                                             map, /* on_uv= */ false);
    const dmat3 turn = glm::inverse(dmat3(to_world));
    PlacedTexture layer{texture, {}};
    for (int row = 0; row < 3; ++row)
        layer.to_texture[size_t(row)] = dvec4(turn[0][row], turn[1][row], turn[2][row], 0);
    sky_->layers.push_back(layer);
}

Emission Lights::emission(const Parameters& p, const Place& place) const {
    Emission emission;
    emission.radiance = scaled(p, "L", vec3(1));
    emission.two_sided = p.flag("twosided", false);
    if (asks_for(p, "power"))
        emission.power = p.number("power", -1);
    const std::string file = p.text("filename");
    if (file.empty())
        return emission;
    ImageTexture picture;
    picture.filter = TexelFilter::Smooth;
    picture.otherwise = {vec3(1)};
    if (emission.power)
        picture.per = ImageTexture::Measure::Mean;
    emission.picture = textures_.image(file, place, picture, /* on_uv= */ true);
    return emission;
}

vec3 radiance_of(const Emission& emission, const Shape& shape) {
    if (!emission.power)
        return emission.radiance;
    const uint64_t emitters = shape.mesh.emitters > 0 ? shape.mesh.emitters : shape.mesh.size();
    const double of_one =
        (emission.two_sided ? 2 : 1) * pi * surface_area(shape) / double(emitters);
    return of_one > 0 ? float(*emission.power / of_one) * emission.radiance : emission.radiance;
}

void Lights::add_area(const Shape& shape, const vec3& radiance, bool two_sided) {
    any_ = true;
    for (Light light : lights_on(shape, radiance, two_sided)) {
        light.stand_in = true;
        area_lights_.push_back(light);
    }
}

void Lights::finish(const dvec3& view_up, Scene& scene) {
    if (!any_)
        return;
    if (area_lights_.size() > kMaxAreaLights) {
        // The strongest lights stay, and take over the light of the others.
        const auto weight = [](const Light& light) { return mean(light.color); };
        std::stable_sort(area_lights_.begin(), area_lights_.end(),
                         [&](const Light& a, const Light& b) { return weight(a) > weight(b); });
        float kept = 0, all = 0;
        for (size_t i = 0; i < area_lights_.size(); ++i) {
            all += weight(area_lights_[i]);
            kept += i < kMaxAreaLights ? weight(area_lights_[i]) : 0;
        }
        area_lights_.resize(kMaxAreaLights);
        for (Light& light : area_lights_)
            light.color *= kept > 0 ? all / kept : 1;
    }
    scene.lights = std::move(lights_);
    scene.lights.insert(scene.lights.end(), area_lights_.begin(), area_lights_.end());
    scene.background = sky_.value_or(Background{vec3(0), vec3(0)});
    sky_mean_ = 0.5f * (scene.background.horizon + scene.background.zenith);
    if (skies_ > 1 && !scene.background.layers.empty()) {
        scene.background.horizon = scene.background.zenith = even_sky_;
        scene.background.layers_add = true;
    }
    if (sky_) {
        Light above;
        above.parallel = above.distant = true;
        above.direction = glm::length(view_up) > 0 ? -glm::normalize(view_up) : dvec3(0, -1, 0);
        above.stand_in = true;
        above.color = sky_mean_ * float(pi) * kSkyFromAbove;
        scene.lights.push_back(above);
        for (Material& material : scene.materials)
            if (material.finish && material.finish->diffuse > 0)
                material.finish->ambient += kSkyAmbient * sky_mean_;
    }
}

} // namespace ovc::pbrt
