// SPDX-License-Identifier: Apache-2.0
// The four parts of a Bsdf: Lambert below a coat, GGX, mirror and glass.
#include "host/shade/surface/bsdf.h"

#include "core/fresnel.h"
#include "host/shade/refract.h"
#include "host/shade/surface/microfacet.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ovc {

/// Narrower highlights count as mirrors: they are narrower than a pixel, and pbrt draws the line
/// here.
static constexpr double kSmooth = 1e-3;

static float average(const vec3& c) {
    return (c.x + c.y + c.z) / 3;
}

vec3 Reflectance::at(double cosine) const {
    switch (curve) {
    case Curve::Constant:
        return head_on;
    case Curve::Schlick: {
        const double x = std::clamp(1 - cosine, 0.0, 1.0);
        return glm::mix(head_on, vec3(1), float(x * x * x * x * x));
    }
    case Curve::Fresnel:
        return head_on * float(fresnel(cosine, ior));
    }
    return vec3(0);
}

vec3 Reflectance::mean() const {
    switch (curve) {
    case Curve::Constant:
        return head_on;
    case Curve::Schlick:
        return glm::mix(head_on, vec3(1), 1 / 21.0f);
    case Curve::Fresnel:
        return head_on * float(fresnel_mean(ior));
    }
    return vec3(0);
}

/// Makes a right-handed frame about a normal. Duff et al. 2017, "Building an Orthonormal Basis,
/// Revisited".
static void frame(const dvec3& n, dvec3& tangent, dvec3& bitangent) {
    const double sign = std::copysign(1.0, n.z);
    const double a = -1 / (sign + n.z);
    const double b = n.x * n.y * a;
    tangent = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
    bitangent = {b, sign + n.y * n.y * a, -n.y};
}

Bsdf::Bsdf(const SurfacePoint& surface) : geometric_(surface.geometric_normal) {
    // A facet that is seen from behind its interpolated normal takes its own normal.
    const double facing = -glm::dot(surface.view, surface.normal);
    normal_ = facing > 1e-6 ? surface.normal : surface.geometric_normal;
    frame(normal_, tangent_, bitangent_);
    view_ = local(-surface.view);
    view_.z = std::max(view_.z, 1e-9); // a rounding may put an edge-on view below the plane
    const Material& material = *surface.material;
    if (material.optics && (material.texture || material.maps))
        take_optics(surface, optics_at(surface));
    else if (material.optics)
        take_optics(surface, *material.optics);
    else if (material.finish)
        take_finish(surface);
    else
        take_shares(surface);
    choose_probabilities();
}

vec3 Bsdf::albedo() const {
    const vec3 gloss = is_glossy_ ? gloss_.at(view_.z) : vec3(0);
    return glm::clamp(diffuse_ + behind_ + gloss + mirror_ + through_ + frosted_, vec3(0), vec3(1));
}

static Reflectance reflectance_of(const Optics& optics, bool from_outside) {
    using Boundary = Optics::Boundary;
    switch (optics.boundary) {
    case Boundary::None:
        return {};
    case Boundary::Mirror:
        return {Reflectance::Curve::Constant, optics.reflection, 1};
    case Boundary::Metal:
        return {Reflectance::Curve::Schlick, optics.reflection, 1};
    case Boundary::Dielectric:
        return {Reflectance::Curve::Fresnel, optics.reflection,
                from_outside ? optics.ior : 1 / optics.ior};
    case Boundary::Thin:
        return {Reflectance::Curve::Fresnel, optics.reflection, optics.ior};
    }
    return {};
}

void Bsdf::take_optics(const SurfacePoint& surface, const Optics& optics) {
    const bool clear = optics.through != vec3(0);
    // The back of an opaque surface is like its front: there is no inside to look out of.
    Reflectance boundary = reflectance_of(optics, surface.entering || !clear);
    if (surface.entering || optics.two_sided)
        emission_ = optics.emission;
    diffuse_ = optics.diffuse;
    behind_ = optics.diffuse_behind;
    if (optics.internal_reflection)
        diffuse_ *= share_from_below(optics.diffuse, optics.ior);
    // Ground and glass that share out the light lie beside each other, as in a mix of them.
    const bool is_beside = clear && max_component(optics.reflection + diffuse_) <= 1.00001f;
    if (optics.boundary != Optics::Boundary::None && diffuse_ != vec3(0) && !is_beside) {
        coat_ = boundary;
        coat_scale_ = 1.0f / glm::max(vec3(1) - boundary.mean(), vec3(1e-6f));
    }
    const bool is_dielectric = optics.boundary == Optics::Boundary::Dielectric;
    if (clear && is_dielectric && optics.width >= kSmooth && optics.ior != 1) {
        frosted_ = optics.through;
        bent_ = float(1 / (boundary.ior * boundary.ior));
    }
    if (clear && frosted_ == vec3(0)) {
        const bool total = is_dielectric && fresnel(view_.z, boundary.ior) >= 1;
        double share =
            optics.boundary == Optics::Boundary::None ? 0 : fresnel(view_.z, boundary.ior);
        if (optics.boundary == Optics::Boundary::Thin)
            share = 2 * share / (1 + share); // light also goes from side to side within
        mirror_ = optics.reflection * float(share);
        through_ = total ? vec3(0) : optics.through * float(1 - share);
        if (is_dielectric) {
            is_straight_ = false;
            bent_ = float(1 / (boundary.ior * boundary.ior));
        }
    } else if (optics.boundary != Optics::Boundary::None && optics.width < kSmooth) {
        mirror_ = boundary.at(view_.z);
    } else if (optics.boundary != Optics::Boundary::None) {
        is_glossy_ = true;
        gloss_ = boundary;
        width_ = std::min(double(optics.width), 1.0);
    }
}

/// Takes Whitted's shares. Radiance changes at a boundary of glass as it does for Optics.
void Bsdf::take_shares(const SurfacePoint& surface) {
    const Material& material = *surface.material;
    const bool total = material.transmission > 0 && material.ior != 1 &&
                       fresnel(view_.z, surface.entering ? material.ior : 1 / material.ior) >= 1;
    const Branches parts = branches(surface, total);
    mirror_ = parts.mirror;
    through_ = parts.through;
    is_straight_ = material.ior == 1;
    bent_ =
        float(surface.entering ? 1 / (material.ior * material.ior) : material.ior * material.ior);
    diffuse_ = surface.color * std::max(1 - parts.taken_by_mirror - parts.taken_by_through, 0.0f);
}

/// Takes POV-Ray's terms, of all coats together. Where they add up to more light than arrives, it
/// dims all alike.
void Bsdf::take_finish(const SurfacePoint& surface) {
    take_shares(surface);
    diffuse_ = vec3(0);
    double widths = 0; // times the strengths of their highlights
    if (surface.coats.empty())
        widths = add_finish(surface, vec3(1));
    for (const Coat& coat : surface.coats)
        widths += add_finish(coat.surface, coat.weight);
    if (is_glossy_)
        width_ = std::clamp(widths / double(average(gloss_.head_on)), kSmooth, 1.0);
    const float sum = max_component(diffuse_ + gloss_.head_on + mirror_ + through_);
    if (sum > 1)
        for (vec3* part : {&diffuse_, &gloss_.head_on, &mirror_, &through_})
            *part /= sum;
}

/// Adds a finish that is seen with this weight. Returns the width of its highlight times the
/// highlight's strength.
double Bsdf::add_finish(const SurfacePoint& surface, const vec3& weight) {
    if (!surface.material->finish)
        return 0;
    const Finish& finish = *surface.material->finish;
    // On a diffuse surface ambient light stands for light from other surfaces, which path tracing
    // finds itself. POV-Ray 3.7 drops it in the same way where there is radiosity.
    const vec3 color = weight * surface.opacity * surface.color;
    emission_ += color * (finish.diffuse > 0 ? finish.emission : finish.ambient);
    diffuse_ += color * finish.diffuse;
    // A highlight of Blinn's exponent n is as wide as alpha^2 = 2 / (n + 2), and (n + 2) / 8 high
    // over pi where all light is reflected; Phong's of m is as wide as Blinn's of 4 m.
    const bool blinn = finish.specular > 0 && finish.roughness > 0;
    const double exponent = blinn ? 1 / double(finish.roughness) : 4 * double(finish.phong_size);
    const float height = surface.maps.gloss() * (blinn ? finish.specular : finish.phong);
    const vec3 share = weight * std::min(float(8 * height / (exponent + 2)), 1.0f) *
                       glm::mix(vec3(1), surface.color, finish.metallic);
    if (!(average(share) > 0))
        return 0;
    is_glossy_ = true;
    gloss_.head_on += share;
    return double(average(share)) * std::sqrt(2 / (exponent + 2));
}

/// Makes each way as probable as the light that it is about to send on.
void Bsdf::choose_probabilities() {
    const vec3 below = coat_ ? vec3(1) - coat_->at(view_.z) : vec3(1);
    vec3 reflected = gloss_.at(view_.z);
    if (frosted_ != vec3(0)) // some facets let through where a smooth surface does not
        reflected = glm::clamp(reflected, vec3(0.1f), vec3(0.9f));
    const double in_front = double(average(diffuse_ * below));
    const double diffuse = in_front + double(average(behind_));
    front_ = diffuse > 0 ? in_front / diffuse : 1;
    chance_ = {diffuse, is_glossy_ ? double(average(reflected)) : 0, double(average(mirror_)),
               double(average(through_ + frosted_ * (vec3(1) - reflected)))};
    const double sum = chance_[0] + chance_[1] + chance_[2] + chance_[3];
    for (double& chance : chance_)
        chance = sum > 0 ? std::max(chance, 0.0) / sum : 0;
}

dvec3 Bsdf::local(const dvec3& d) const {
    return {glm::dot(d, tangent_), glm::dot(d, bitangent_), glm::dot(d, normal_)};
}

dvec3 Bsdf::world(const dvec3& d) const {
    return d.x * tangent_ + d.y * bitangent_ + d.z * normal_;
}

bool Bsdf::is_above(const dvec3& towards) const {
    return glm::dot(towards, normal_) > 0 && glm::dot(towards, geometric_) > 0;
}

bool Bsdf::is_below(const dvec3& towards) const {
    return glm::dot(towards, normal_) < 0 && glm::dot(towards, geometric_) < 0;
}

/// Returns evaluate() for `towards` in the frame and above the surface.
vec3 Bsdf::scattered(const dvec3& towards) const {
    vec3 sum = diffuse_ * float(towards.z * std::numbers::inv_pi);
    // Light goes through the coat on its way in and on its way out, and light that the coat throws
    // back down finds its way out too. This is reciprocal, and a white ground reflects 1 - coat at
    // the viewer's angle in all.
    // Shirley et al. 1997, "A Practitioners' Assessment of Light Reflection Models", section 3.
    if (coat_)
        sum *= (vec3(1) - coat_->at(view_.z)) * (vec3(1) - coat_->at(towards.z)) * coat_scale_;
    if (is_glossy_) {
        const dvec3 half = glm::normalize(view_ + towards);
        sum +=
            gloss_.at(glm::dot(view_, half)) * float(Microfacets{width_}.reflected(view_, towards));
    }
    return sum;
}

double Bsdf::scattered_density(const dvec3& towards) const {
    double sum = chance_[0] * front_ * towards.z * std::numbers::inv_pi;
    if (is_glossy_)
        sum += chance_[1] * Microfacets{width_}.density(view_, towards);
    return sum;
}

/// Returns evaluate() for `towards` in the frame and below the surface.
vec3 Bsdf::transmitted(const dvec3& towards) const {
    const vec3 diffuse = behind_ * float(-towards.z * std::numbers::inv_pi);
    if (frosted_ == vec3(0))
        return diffuse;
    const dvec3 half = Microfacets::refracting_facet(view_, towards, gloss_.ior);
    const double share = 1 - fresnel(glm::dot(view_, half), gloss_.ior);
    return diffuse + frosted_ * float(share * double(bent_) *
                                      Microfacets{width_}.refracted(view_, towards, gloss_.ior));
}

double Bsdf::transmitted_density(const dvec3& towards) const {
    const double diffuse = chance_[0] * (1 - front_) * -towards.z * std::numbers::inv_pi;
    return frosted_ == vec3(0)
               ? diffuse
               : diffuse +
                     chance_[3] * Microfacets{width_}.refracted_density(view_, towards, gloss_.ior);
}

vec3 Bsdf::evaluate(const dvec3& towards) const {
    if (!scatters())
        return vec3(0);
    return is_above(towards)   ? scattered(local(towards))
           : is_below(towards) ? transmitted(local(towards))
                               : vec3(0);
}

double Bsdf::density(const dvec3& towards) const {
    if (!scatters())
        return 0;
    return is_above(towards)   ? scattered_density(local(towards))
           : is_below(towards) ? transmitted_density(local(towards))
                               : 0;
}

/// Chooses a direction by the cosine. Malley's method lifts a point of the disk.
static dvec3 cosine_way(const dvec2& u) {
    const double r = std::sqrt(u.x), phi = 2 * std::numbers::pi * u.y;
    return {r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(1 - u.x, 0.0))};
}

std::optional<Scattered> Bsdf::sample(double choice, const dvec2& u) const {
    size_t way = 0;
    while (way < 3 && choice >= chance_[way])
        choice -= chance_[way++];
    while (way > 0 && !(chance_[way] > 0)) // a rounding may lead beyond the last way with a chance
        --way;
    if (!(chance_[way] > 0))
        return std::nullopt;
    const auto chosen = Scattering(way);
    if (chosen == Scattering::Mirror)
        return Scattered{chosen, {}, mirror_ / float(chance_[way]), 0};
    if (chosen == Scattering::Through && frosted_ == vec3(0))
        return Scattered{chosen, {}, through_ * float(bent_ / chance_[way]), 0};
    const bool is_in_front =
        chosen == Scattering::Diffuse ? choice < front_ * chance_[0] : chosen == Scattering::Glossy;
    dvec3 towards = cosine_way(u) * dvec3(1, 1, is_in_front ? 1 : -1);
    if (chosen == Scattering::Glossy)
        towards = Microfacets{width_}.reflected_way(view_, u);
    else if (chosen == Scattering::Through)
        towards = refracted(-view_, Microfacets{width_}.seen_facet(view_, u), 1, gloss_.ior)
                      .value_or(dvec3(0)); // reflected totally: Glossy has the chance of that
    const dvec3 direction = world(towards);
    // A facet may send light to the wrong side, where it is lost.
    if (!(is_in_front ? towards.z > 0 && is_above(direction)
                      : towards.z < 0 && is_below(direction)))
        return std::nullopt;
    const double density = is_in_front ? scattered_density(towards) : transmitted_density(towards);
    if (!(density > 0))
        return std::nullopt;
    const vec3 light = is_in_front ? scattered(towards) : transmitted(towards);
    return Scattered{chosen, direction, light / float(density), density};
}

} // namespace ovc
