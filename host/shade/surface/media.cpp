// SPDX-License-Identifier: Apache-2.0
// POV-Ray's documentation (section 3.5.2, "Media") says what a medium is; how strong it is, and
// where along a ray povray looks at it, was found by asking povray for values.
#include "host/shade/surface/media.h"

#include "core/texture/pattern.h"

#include <algorithm>
#include <cmath>

namespace ovc {

bool has_media(const Scene& scene) {
    return !scene.background.media.empty() ||
           std::any_of(scene.materials.begin(), scene.materials.end(),
                       [](const Material& material) { return !material.media.empty(); });
}

size_t max_shadow_rays(const Scene& scene) {
    const auto scatters = [](const std::vector<Medium>& media) {
        return std::any_of(media.begin(), media.end(),
                           [](const Medium& medium) { return medium.scattering != vec3(0); });
    };
    const bool any =
        scatters(scene.background.media) ||
        std::any_of(scene.materials.begin(), scene.materials.end(),
                    [&](const Material& material) { return scatters(material.media); });
    if (!any)
        return scene.lights.size();
    double asked = 1; // lights by each place
    for (const Light& light : scene.lights)
        asked += 1.0 / light.area_points;
    return scene.lights.size() + size_t(asked * kMaxScatteringPlaces);
}

/// The factors are those of povray 3.7.0.10, as measured of its pixels at fifteen angles.
double phase_of(const Medium& medium, double cosine) {
    const double e = double(medium.eccentricity), forward = 0.5 * (1 + cosine);
    switch (medium.phase) {
    case Medium::Phase::Even:
        break;
    case Medium::Phase::MieHazy:
        return 0.57666 * (1 + 9 * std::pow(forward, 8));
    case Medium::Phase::MieMurky:
        return 0.49571 * (1 + 50 * std::pow(forward, 32));
    case Medium::Phase::Rayleigh:
        return 0.79937 * (1 + cosine * cosine);
    case Medium::Phase::HenyeyGreenstein:
        return (1 - e * e) / std::pow(1 + e * e - 2 * e * cosine, 1.5);
    }
    return 1;
}

/// Returns the density at a point of the world.
static vec3 density_at(std::span<const Texture> textures, const Medium& medium, const dvec3& at) {
    vec3 density(1);
    for (const PlacedTexture& placed : medium.densities)
        density *= color_at(textures, placed, at).rgb;
    return glm::max(density, vec3(0));
}

/// Returns the share of light that is lost on a unit of length where the density is 1.
static vec3 lost_in(const Medium& medium) {
    return medium.absorption + medium.extinction * medium.scattering;
}

namespace {

/// The places in which a ray looks at media: the way is cut into intervals, these into parts, and a
/// part is looked at in its ends and its middle, and halved where these differ. As in povray, an
/// interval's end is not reached: N parts take up N / (N + 1) of it, and stand for all of it. What
/// comes from a part is dimmed by the parts before it, and not by itself.
class Way {
public:
    Way(std::span<const Texture> textures, MediaAlong media, const Ray& ray)
        : textures_(textures), media_(media), ray_(ray) {
        how_.samples = 1;
        how_.levels = 0;
        for (const Medium* medium : media) {
            how_.intervals = std::max(how_.intervals, medium->intervals);
            how_.samples = std::max(how_.samples, medium->samples);
            how_.levels = std::max(how_.levels, medium->levels);
            how_.threshold = medium->threshold;
            scatters_ = scatters_ || medium->scattering != vec3(0);
        }
        if (!scatters_)
            how_.intervals = 1; // as povray takes it
        how_.intervals = std::min(how_.intervals, kMaxScatteringPlaces / kMinPlaces);
        how_.samples = std::min(how_.samples, (kMaxScatteringPlaces / how_.intervals - 1) / 2);
    }

    /// Adds what comes from the way from `begin` to `end`, which are values of t.
    void add(double begin, double end, ThroughMedia& all) {
        for (uint32_t i = 0; i < how_.intervals; ++i) {
            const double length = (end - begin) / how_.intervals;
            add_interval(begin + i * length, length, all);
        }
    }

private:
    static constexpr uint32_t kMinPlaces = 5; // of an interval

    struct Place {
        double t;
        vec3 lost{0}, sent{0}; // on a unit of length
        float weight = 0;      // of the place in its part
        vec3 share{0};         // of its light that arrives, times its weight in the interval
    };

    void add_interval(double begin, double length, ThroughMedia& all) {
        places_.clear();
        const uint32_t parts = how_.samples;
        const float part = float(length * glm::length(ray_.dir)) / float(parts);
        const double step = how_.levels == 0 ? length / parts : length / (parts + 1);
        size_t last = how_.levels == 0 ? 0 : look_at(begin);
        for (uint32_t i = 0; i < parts; ++i) {
            const size_t first = last;
            if (how_.levels == 0) { // povray's methods 1 and 2
                look_at(begin + (i + 0.5) * step);
                places_.back().weight = 1;
            } else {
                last = look_at(begin + (i + 1) * step);
                halve(first, last, how_.levels, 1);
            }
            vec3 lost(0);
            for (size_t p = first; p < places_.size(); ++p)
                lost += part * places_[p].weight * places_[p].lost;
            const vec3 here = all.share * (how_.levels == 0 ? glm::exp(-0.5f * lost) : vec3(1));
            for (size_t p = first; p < places_.size(); ++p) {
                places_[p].share += part * places_[p].weight * here;
                places_[p].weight = 0;
            }
            all.share *= glm::exp(-lost);
            last = how_.levels == 0 ? places_.size() : last;
        }
        for (const Place& place : places_)
            hand_out(place, all);
    }

    /// Looks in the middle between two places, and gives their part of the way, whose share of the
    /// whole part is `weight`, to the three or to smaller ones.
    void halve(size_t a, size_t b, uint32_t levels, float weight) {
        const size_t middle = look_at(0.5 * (places_[a].t + places_[b].t));
        const auto differ = [&](size_t one, size_t other) {
            const vec3 d = glm::abs(places_[one].sent - places_[other].sent);
            return d.x + d.y + d.z > how_.threshold;
        };
        if (levels > 1 && places_.size() < kMaxPlaces && (differ(a, middle) || differ(middle, b))) {
            halve(a, middle, levels - 1, 0.5f * weight);
            halve(middle, b, levels - 1, 0.5f * weight);
        } else
            for (const size_t p : {a, middle, b})
                places_[p].weight += weight / 3;
    }

    size_t look_at(double t) {
        Place place{t};
        for (const Medium* medium : media_) {
            const vec3 density = density_at(textures_, *medium, ray_.org + t * ray_.dir);
            place.lost += density * lost_in(*medium);
            place.sent += density * (medium->emission + medium->scattering);
        }
        places_.push_back(place);
        return places_.size() - 1;
    }

    void hand_out(const Place& place, ThroughMedia& all) const {
        const dvec3 at = ray_.org + place.t * ray_.dir;
        for (const Medium* medium : media_) {
            const vec3 share = place.share * density_at(textures_, *medium, at);
            all.added += share * medium->emission;
            if (medium->scattering != vec3(0) && share != vec3(0) &&
                all.scattering.size() < kMaxScatteringPlaces)
                all.scattering.push_back({at, share * medium->scattering, medium});
        }
    }

    static constexpr size_t kMaxPlaces = 1024; // of an interval

    const std::span<const Texture> textures_;
    const MediaAlong media_;
    const Ray& ray_;
    Medium how_;
    bool scatters_ = false;
    std::vector<Place> places_;
};

} // namespace

vec3 share_through_media(std::span<const Texture> textures, MediaAlong media, const Ray& ray,
                         double t) {
    constexpr uint32_t kPlaces = 8;
    const bool is_even = std::all_of(
        media.begin(), media.end(), [](const Medium* medium) { return medium->densities.empty(); });
    const uint32_t places = is_even ? 1 : kPlaces;
    vec3 lost(0);
    for (uint32_t i = 0; i < places; ++i)
        for (const Medium* medium : media)
            lost += density_at(textures, *medium, ray.org + (i + 0.5) / places * t * ray.dir) *
                    lost_in(*medium);
    return glm::exp(-float(t * glm::length(ray.dir) / places) * lost);
}

ThroughMedia through_media(std::span<const Texture> textures, MediaAlong media, const Ray& ray,
                           std::span<const double> ends) {
    ThroughMedia all;
    Way way(textures, media, ray);
    for (size_t i = 0; i + 1 < ends.size(); ++i)
        way.add(ends[i], ends[i + 1], all);
    return all;
}

} // namespace ovc
