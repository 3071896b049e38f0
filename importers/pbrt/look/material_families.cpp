// SPDX-License-Identifier: Apache-2.0
// Each family of materials has a function; a table maps the names of v1 to v4 to it.
// Based on: pbrt's materials; Blinn 1977 (a lobe of exponent n); Schlick 1994 (metals).
#include "importers/pbrt/look/material_families.h"

#include "importers/file/picture_path.h"

namespace ovc::pbrt {

namespace {

/// Surfaces rougher than this show a highlight instead of mirror images.
constexpr double kMirrorRoughness = 0.1;

/// The index of refraction of plastic, paint and other materials that do not state one.
constexpr double kPlasticIor = 1.5;

/// Returns the roughness that most materials have. of: what stands before the parameters' names.
double roughness_of(const MaterialContext& c, double otherwise, const std::string& of = {}) {
    const std::string along_u = of + "uroughness", along_v = of + "vroughness";
    double r = c.number(of + "roughness", otherwise);
    if (c.p.find(along_u) || c.p.find(along_v))
        r = 0.5 * (c.number(along_u, r) + c.number(along_v, r));
    return std::clamp(r, 0.0, 1.0);
}

/// Returns the width of the microfacets' slopes, 0 to 1, as v4 has it: the root of the roughness,
/// unless the file says that the roughness is the width itself.
double width_of(const MaterialContext& c, double roughness) {
    return c.p.flag("remaproughness", true) ? std::sqrt(roughness) : roughness;
}

/// Returns the same for the materials of v3, which fits a curve to exponents of highlights.
double width_before_v4(const MaterialContext& c, double roughness) {
    if (!c.p.flag("remaproughness", true))
        return roughness;
    double width = 0;
    const double x = std::log(std::max(roughness, 1e-3));
    for (const double coefficient : {0.000640711, 0.0171201, 0.1734, 0.819955, 1.62142})
        width = width * x + coefficient;
    return std::min(width, 1.0);
}

/// Adds a highlight as strong as that of microfacets which reflect `share`.
void add_highlight(Finish& finish, float share, double width) {
    const double exponent = std::clamp(2 / (width * width + 1e-6) - 2, 1.0, 2000.0);
    finish.specular = share * float((exponent + 2) / 8);
    finish.roughness = float(1 / exponent);
}

Finish plain_finish() {
    Finish finish;
    finish.ambient = vec3(kAmbient);
    return finish;
}

std::optional<double> stated_ior(const MaterialContext& c) {
    for (const std::string_view name : {"eta", "index", "ior"}) {
        const Parameter* p = c.p.find(name);
        if (!p)
            continue;
        if (const auto glass = p->strings.empty() ? std::nullopt : glass_ior(p->strings[0]))
            return glass;
        if (p->kind == Kind::Spectrum && p->numbers.size() > 2)
            c.diagnostics.approximate("index of a spectrum", c.place,
                                      "glass has the same index of refraction for all colors");
        const double ior = c.number(name, 1.5);
        return is_usable_ior(ior) ? std::optional(ior) : std::nullopt;
    }
    return std::nullopt;
}

/// Adds mirror images by Fresnel's equations.
void add_coat(Material& m, const vec3& color) {
    m.mirror = 1;
    m.finish->fresnel = true;
    m.finish->grazing_reflection = color;
}

/// Gives the material the texture of its color, times `factor`.
void take_color(const MaterialContext& c, std::string_view name, const vec3& factor, Material& m) {
    if (const auto texture = c.texture(name))
        m.texture = placed_in_world(c.textures.product(*texture, factor));
}

/// Gives it the texture of the share that its boundary reflects, whose mean is then no part of it.
void take_reflection(const MaterialContext& c, std::string_view name, Material& m) {
    const auto texture = c.texture(name);
    if (!texture)
        return;
    if (!m.maps)
        m.maps.emplace();
    m.maps->reflection = *texture;
    const vec3 color = glm::max(c.color(name, 0.5f), vec3(1e-3f));
    m.optics->reflection /= color;
    m.finish->specular /= mean(color);
    m.finish->reflection /= color;
    m.finish->grazing_reflection /= color;
}

/// Reads the color from the parameter `reflectance`, whose name depends on the version. share: of
/// the color that is reflected.
Material matte(const MaterialContext& c, std::string_view reflectance, float otherwise = 0.5f,
               const vec3& share = vec3(1)) {
    Material m;
    m.color = share * c.color(reflectance, otherwise);
    take_color(c, reflectance, share, m);
    m.finish = plain_finish();
    m.optics = Optics{.diffuse = m.color};
    return m;
}

/// Returns paint of this color below clear varnish that reflects `coat` of Fresnel's share.
Optics varnished(const vec3& color, const vec3& coat, double ior, double width) {
    return {.diffuse = color,
            .boundary = Optics::Boundary::Dielectric,
            .reflection = coat,
            .ior = ior,
            .width = float(width)};
}

} // namespace

Material make_matte(const MaterialContext& c) {
    return matte(c, c.p.find("reflectance") ? "reflectance" : "Kd");
}

namespace {

/// Plastic and substrate are paint below a coat.
Material make_plastic(const MaterialContext& c) {
    const bool v4 = c.p.find("reflectance") != nullptr;
    Material m;
    m.color = v4 ? c.color("reflectance", 0.5f) : c.color("Kd", 0.25f);
    take_color(c, v4 ? "reflectance" : "Kd", vec3(1), m);
    m.finish = plain_finish();
    const vec3 coat = c.color("Ks", 0.25f);
    const double width = width_before_v4(c, roughness_of(c, 0.1));
    add_highlight(*m.finish, mean(coat), width);
    m.optics = varnished(m.color, coat, kPlasticIor, width);
    take_reflection(c, "Ks", m);
    return m;
}

Material make_coated_diffuse(const MaterialContext& c) {
    Material m = matte(c, "reflectance");
    const double width = width_of(c, roughness_of(c, 0));
    m.ior = stated_ior(c).value_or(1.5);
    const double f0 = (m.ior - 1) * (m.ior - 1) / ((m.ior + 1) * (m.ior + 1));
    add_highlight(*m.finish, float(f0), width);
    if (width <= kMirrorRoughness)
        add_coat(m, vec3(1));
    m.optics = varnished(m.color, vec3(1), m.ior, width);
    m.optics->internal_reflection = true;
    return m;
}

Material make_mirror(const MaterialContext& c) {
    Material m;
    m.color = vec3(0);
    m.mirror = 1;
    m.finish = Finish{};
    m.finish->diffuse = 0;
    m.finish->reflection = m.finish->grazing_reflection = c.color("Kr", 0.9f);
    m.optics = Optics{.boundary = Optics::Boundary::Mirror, .reflection = m.finish->reflection};
    take_reflection(c, "Kr", m);
    return m;
}

/// If is_thin, the glass has no thickness, and light goes straight on. width: of its facets.
Material make_glass(const MaterialContext& c, bool is_thin, double width = 0) {
    Material m;
    m.color = vec3(0);
    m.mirror = 1;
    m.transmission = 1;
    m.filter = c.color("Kt", 1);
    m.finish = Finish{};
    m.finish->diffuse = 0;
    m.finish->conserve_energy = true;
    const double ior = stated_ior(c).value_or(1.5);
    m.optics = Optics{.boundary = is_thin ? Optics::Boundary::Thin : Optics::Boundary::Dielectric,
                      .reflection = c.color("Kr", 1),
                      .through = m.filter,
                      .ior = ior,
                      .width = float(width)};
    if (is_thin) {
        const double r = (ior - 1) * (ior - 1) / ((ior + 1) * (ior + 1));
        m.finish->reflection = vec3(float(2 * r / (1 + r))) * c.color("Kr", 1);
        m.finish->grazing_reflection = c.color("Kr", 1);
        m.finish->reflection_falloff = 5;
    } else {
        m.ior = ior;
        add_coat(m, c.color("Kr", 1));
    }
    return m;
}

Material make_thick_glass(const MaterialContext& c) {
    const double roughness = roughness_of(c, 0);
    return make_glass(c, c.p.flag("thin", false),
                      roughness > 0 ? width_before_v4(c, roughness) : 0);
}

Material make_dielectric(const MaterialContext& c) {
    return make_glass(c, /* is_thin= */ false, width_of(c, roughness_of(c, 0)));
}

Material make_thin_glass(const MaterialContext& c) {
    return make_glass(c, true);
}

/// The eta and k of a metal, or its name.
struct MetalOf {
    std::string name;
    vec3 eta{1}, k{0};
};

/// of: what stands before the names of the parameters.
MetalOf metal_of(const MaterialContext& c, const std::string& of = {}) {
    if (c.p.find("reflectance")) { // as pbrt makes a metal of it
        const vec3 r = glm::min(c.color("reflectance", 0.9f), vec3(0.9999f));
        return {{}, vec3(1), 2.0f * glm::sqrt(r / (vec3(1) - r))};
    }
    const std::string eta = of + "eta", k = of + "k";
    for (const Parameter* const p : {c.p.find(eta), c.p.find(k)})
        if (p && !p->strings.empty() && metal_color(p->strings[0]))
            return {p->strings[0]};
    if (!c.p.find(eta) && !c.p.find(k))
        return {"Cu"};
    return {{},
            c.textures.color(c.p, eta, vec3(0.2f, 0.9f, 1.1f)),
            c.textures.color(c.p, k, vec3(3.9f, 2.5f, 2.3f))};
}

vec3 color_of(const MetalOf& metal) {
    return metal.name.empty() ? glm::clamp(metal_color(metal.eta, metal.k), vec3(0), vec3(1))
                              : *metal_color(metal.name);
}

/// The rougher a metal, the less it mirrors and the more it looks like matte paint.
Material metal(const vec3& color, double width) {
    Material m;
    m.color = color;
    m.mirror = 1;
    m.finish = plain_finish();
    const float sharp = float((1 - width) * (1 - width));
    m.finish->diffuse = 0.7f * (1 - sharp);
    m.finish->metallic = 1;
    m.finish->reflection = color * sharp;
    m.finish->grazing_reflection = vec3(sharp);
    m.finish->reflection_falloff = 5;
    add_highlight(*m.finish, 1, width);
    m.optics =
        Optics{.boundary = Optics::Boundary::Metal, .reflection = color, .width = float(width)};
    return m;
}

Material make_metal(const MaterialContext& c) {
    Material m = metal(color_of(metal_of(c)), width_before_v4(c, roughness_of(c, 0.01)));
    take_reflection(c, "reflectance", m);
    return m;
}

Material make_conductor(const MaterialContext& c) {
    Material m = metal(color_of(metal_of(c)), width_of(c, roughness_of(c, 0)));
    take_reflection(c, "reflectance", m);
    return m;
}

/// A smooth metal and its coat mirror together. The metal below a coat has names of its own.
Material make_coated_conductor(const MaterialContext& c) {
    const MetalOf below = metal_of(c, "conductor.");
    const double roughness = roughness_of(c, 0, "conductor.");
    if (roughness > 0)
        c.diagnostics.approximate("coat of a metal", c.place,
                                  "the coats of rough metals are as rough as these");
    const vec3 color = below.name.empty()
                           ? coated_metal_color(below.eta, below.k, c.number("interface.eta", 1.5))
                           : *coated_metal_color(below.name);
    Material m = metal(glm::clamp(color, vec3(0), vec3(1)), width_of(c, roughness));
    take_reflection(c, "reflectance", m);
    return m;
}

Material make_shiny_metal(const MaterialContext& c) {
    return metal(c.color("Kr", 1) * c.color("Ks", 1), width_before_v4(c, roughness_of(c, 0.1)));
}

Material make_uber(const MaterialContext& c) {
    const bool is_masked = c.textures.is_pattern(c.p, "opacity");
    const vec3 opacity = is_masked ? vec3(1) : c.color("opacity", 1);
    Material m;
    m.color = c.color("Kd", 0.25f) * opacity;
    take_color(c, "Kd", opacity, m);
    m.finish = plain_finish();
    const vec3 ks = c.color("Ks", 0.25f) * opacity;
    const double width = width_before_v4(c, roughness_of(c, 0.1));
    add_highlight(*m.finish, mean(ks), width);
    const vec3 kr = c.color("Kr", 0) * opacity;
    if (mean(kr) > 0)
        add_coat(m, kr);
    const vec3 kt = c.color("Kt", 0) * opacity;
    m.ior = stated_ior(c).value_or(1.5);
    m.optics =
        mean(kr) > 0 ? varnished(m.color, kr, m.ior, 0) : varnished(m.color, ks, m.ior, width);
    take_reflection(c, mean(kr) > 0 ? "Kr" : "Ks", m);
    const vec3 through = mean(kt) > 0 ? kt : vec3(1) - opacity;
    if (mean(through) > 0) {
        m.transmission = 1;
        m.filter = through;
        m.finish->conserve_energy = true;
        m.optics->width = 0; // light goes straight through, whatever highlights there are
        if (mean(kt) == 0) { // light passes through holes, not through glass
            m.ior = 1;
            m.optics->boundary = Optics::Boundary::None;
        }
        m.optics->through = through;
        m.optics->diffuse = glm::min(m.optics->diffuse, vec3(1) - through);
    }
    return m;
}

void tell_translucent(const MaterialContext& c) {
    c.diagnostics.approximate("translucent", c.place,
                              "light that surfaces let through in all directions is left out");
}

/// Lets a matte surface scatter this light to its other side too.
Material translucent(Material m, const vec3& behind) {
    m.optics->diffuse_behind = glm::clamp(behind, vec3(0), vec3(1));
    if (mean(m.color) > 0)
        m.finish->diffuse_back = mean(behind) / mean(m.color);
    return m;
}

Material make_translucent(const MaterialContext& c) {
    return translucent(matte(c, "Kd", 0.25f, c.color("reflect", 0.5f)),
                       c.color("Kd", 0.25f) * c.color("transmit", 0.5f));
}

Material make_diffuse_transmission(const MaterialContext& c) {
    const vec3 scale(float(c.p.number("scale", 1)));
    return translucent(matte(c, "reflectance", 0.25f, scale),
                       scale * c.color("transmittance", 0.25f));
}

Material make_subsurface(const MaterialContext& c) {
    tell_translucent(c);
    return c.p.find("reflectance") ? matte(c, "reflectance") : matte(c, "Kd");
}

/// In Disney's material, spectrans decides between glass and the rest, and the metallic share
/// between metal and paint.
Material make_disney(const MaterialContext& c) {
    const double roughness = roughness_of(c, 0.5), width = roughness * roughness;
    if (c.number("spectrans", 0) > 0.5)
        return make_glass(c, c.p.flag("thin", false), width);
    if (c.number("metallic", 0) > 0.5)
        return metal(c.color("color", 0.5f), width);
    Material m = matte(c, "color");
    add_highlight(*m.finish, 0.04f, width);
    m.optics = varnished(m.color, vec3(1), kPlasticIor, width);
    return m;
}

/// These materials are tables in files of their own, or models of hair.
Material make_tabulated(const MaterialContext& c) {
    c.diagnostics.approximate("tabulated", c.place,
                              "materials from tables and models of hair become matte grey");
    return matte(c, "reflectance");
}

Material make_invisible(const MaterialContext&) {
    Material m;
    m.color = vec3(0);
    m.transmission = 1;
    m.optics = Optics{.through = vec3(1)};
    return m;
}

/// v1 has measured materials in Lafortune's model, of which only the diffuse part stays.
template <int kRed, int kGreen, int kBlue> // in thousandths
Material make_measured(const MaterialContext&) {
    Material m;
    m.color = vec3(kRed, kGreen, kBlue) * 0.001f;
    m.finish = plain_finish();
    m.optics = Optics{.diffuse = m.color};
    return m;
}

struct Family {
    std::string_view name;
    Material (*make)(const MaterialContext&);
};

constexpr Family kFamilies[] = {{"matte", make_matte},
                                {"diffuse", make_matte},
                                {"plastic", make_plastic},
                                {"substrate", make_plastic},
                                {"coateddiffuse", make_coated_diffuse},
                                {"mirror", make_mirror},
                                {"glass", make_thick_glass},
                                {"roughglass", make_thick_glass},
                                {"dielectric", make_dielectric},
                                {"thindielectric", make_thin_glass},
                                {"metal", make_metal},
                                {"conductor", make_conductor},
                                {"coatedconductor", make_coated_conductor},
                                {"shinymetal", make_shiny_metal},
                                {"uber", make_uber},
                                {"translucent", make_translucent},
                                {"diffusetransmission", make_diffuse_transmission},
                                {"subsurface", make_subsurface},
                                {"kdsubsurface", make_subsurface},
                                {"disney", make_disney},
                                {"fourier", make_tabulated},
                                {"measured", make_tabulated},
                                {"hair", make_tabulated},
                                {"none", make_invisible},
                                {"interface", make_invisible},
                                {"", make_invisible},
                                {"bluepaint", make_measured<309, 397, 708>},
                                {"clay", make_measured<384, 371, 372>},
                                {"felt", make_measured<26, 26, 26>},
                                {"primer", make_measured<118, 122, 135>},
                                {"skin", make_measured<428, 301, 331>}};

} // namespace

/// Adds what tilts normals: heights in the units of the world, or v4's pictures of normals.
static void take_relief(const MaterialContext& c, Material& m) {
    for (const std::string_view name : {"bumpmap", "displacement"})
        if (const auto texture = c.texture(name))
            m.normal_map = NormalMap{c.textures.is_on_uv(*texture) ? NormalMap::Kind::Height
                                                                   : NormalMap::Kind::Space,
                                     *texture};
    const std::string normals = c.p.text("normalmap");
    if (normals.empty())
        return;
    ImageTexture image;
    image.gamma = 1;
    image.otherwise = {vec3(0.5f, 0.5f, 1)};
    m.normal_map = NormalMap{NormalMap::Kind::Tangent,
                             c.textures.image(normals, c.place, image, /* on_uv= */ true)};
}

std::optional<Material> material_of(std::string_view type, const MaterialContext& context) {
    for (const Family& family : kFamilies) {
        if (family.name != type)
            continue;
        Material material = family.make(context);
        take_relief(context, material);
        return material;
    }
    return std::nullopt;
}

std::optional<uint32_t> holes_of(std::string_view type, const MaterialContext& context) {
    return type == "uber" ? context.texture("opacity") : std::nullopt;
}

} // namespace ovc::pbrt
