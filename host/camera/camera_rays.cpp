// SPDX-License-Identifier: Apache-2.0
// Makes camera rays pixel by pixel along a curve, the rays of a pixel one after the other.
#include "host/camera/camera_rays.h"

#include "core/system/parallel.h"
#include "host/shade/path_sampler.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <new>
#include <numbers>
#include <numeric>
#include <utility>

namespace ovc {

static constexpr size_t kCameraGrain = 1024; // rays a task
/// Pixels that get any number of samples have the footprint of so many.
static constexpr uint32_t kCommonSamples = 16;
/// The purposes of a camera ray's random numbers, above those of surfaces of the path tracer.
static constexpr uint32_t kPlace = 1u << 30, kOnLens = kPlace + 1;

/// Returns the first dimension of Sobol's sequence: the bits of i, mirrored behind the point.
static double mirrored_bits(uint32_t i) {
    uint32_t bits = 0;
    for (uint32_t place = 1u << 31; i; i >>= 1, place >>= 1)
        bits ^= (i & 1) * place;
    return bits * 0x1p-32;
}

/// Returns the second dimension, by the columns of Pascal's triangle modulo 2.
static double pascal_bits(uint32_t i) {
    uint32_t bits = 0;
    for (uint32_t column = 1u << 31; i; i >>= 1, column ^= column >> 1)
        bits ^= (i & 1) * column;
    return bits * 0x1p-32;
}

dvec2 sample_place(uint32_t i, uint32_t samples) {
    assert(i < samples);
    const double to_the_middle = 0.5 / samples; // of the smallest strata
    return samples == 1 ? dvec2(0.5)
                        : dvec2(mirrored_bits(i) + to_the_middle, pascal_bits(i) + to_the_middle);
}

/// Returns the cone of the rays through a pixel in the middle of the picture, of which there are so
/// many.
static Cone cone_of(const Pinhole& pinhole, uint32_t samples) {
    const PicturePart& part = pinhole.part();
    // The middle may lie outside of the part; then these wrap around, and the pinhole's sums back.
    const uint32_t x = part.picture.width / 2 - part.left, y = part.picture.height / 2 - part.top;
    const Ray a = pinhole.ray(x, y, dvec2(0, 0.5)), b = pinhole.ray(x, y, dvec2(1, 0.5));
    const double length_a = glm::length(a.dir), length_b = glm::length(b.dir);
    if (!(length_a > 0) || !(length_b > 0))
        return {};
    const double share = 1 / std::sqrt(double(samples));
    return {float(share * glm::length(b.org - a.org)),
            float(share * glm::length(b.dir / length_b - a.dir / length_a))};
}

/// Returns a place in the unit disk, evenly where u is so in [0, 1)^2.
/// Source: Shirley and Chiu 1997, "A Low Distortion Map between Disk and Square".
static dvec2 in_disk(const dvec2& u) {
    const dvec2 v = 2.0 * u - 1.0;
    if (v == dvec2(0))
        return dvec2(0);
    constexpr double kQuarter = std::numbers::pi / 4;
    const bool wide = std::abs(v.x) > std::abs(v.y);
    const double radius = wide ? v.x : v.y;
    const double angle = wide ? kQuarter * (v.y / v.x) : 2 * kQuarter - kQuarter * (v.x / v.y);
    return radius * dvec2(std::cos(angle), std::sin(angle));
}

CameraRays::CameraRays(const Pinhole& pinhole, const Film& film, const CameraSampling& sampling)
    : pinhole_(pinhole),
      cone_(cone_of(pinhole, film.samples())),
      samples_(film.samples()),
      sampling_(sampling),
      filter_(sampling.filter),
      order_(pixel_order(film.width(), film.height())) {
    if (film.pixels_done() > 0) // else nobody touches the film's memory before its light comes
        std::erase_if(order_, [&](uint32_t pixel) { return film.done(pixel); });
}

CameraRays::CameraRays(const Pinhole& pinhole, const Film& film, std::span<const dvec2> points)
    : pinhole_(pinhole),
      cone_(cone_of(pinhole, 1)), // as large as a pixel, however many points it has
      samples_(film.samples()),
      filter_(sampling_.filter),
      points_(points) {
    order_.resize(size_t(film.width()) * film.height());
    assert(points.size() == order_.size() * samples_);
    std::iota(order_.begin(), order_.end(), 0);
    if (film.pixels_done() > 0)
        std::erase_if(order_, [&](uint32_t pixel) { return film.done(pixel); });
}

CameraRays::CameraRays(const Pinhole& pinhole, uint32_t samples, std::vector<uint32_t> pixels,
                       std::span<const dvec2> points, const CameraSampling& sampling)
    : pinhole_(pinhole),
      cone_(cone_of(pinhole, sampling.random_places ? kCommonSamples
                             : points.empty()       ? samples
                                                    : 1)),
      samples_(samples),
      sampling_(sampling),
      filter_(sampling.filter),
      order_(std::move(pixels)),
      points_(points) {}

/// Returns the pixel that a point of the picture lies in.
static glm::uvec2 pixel_at(const Pinhole& pinhole, const dvec2& point) {
    return {std::min(uint32_t(point.x), pinhole.width() - 1),
            std::min(uint32_t(point.y), pinhole.height() - 1)};
}

Ray ray_through(const Pinhole& pinhole, const dvec2& point) {
    const glm::uvec2 pixel = pixel_at(pinhole, point);
    return pinhole.ray(pixel.x, pixel.y, point - dvec2(pixel));
}

CameraRays::Place CameraRays::sampled(uint32_t pixel, uint32_t sample) const {
    const PathSampler random(sampling_.seed, pinhole_.part().number_in_picture(pixel), sample);
    const dvec2 u = sampling_.random_places ? random.pair(kPlace) : sample_place(sample, samples_);
    const bool is_blurred = pinhole_.has_lens() && (samples_ > 1 || sampling_.random_places);
    return {pixel,
            sample,
            pixel % pinhole_.width(),
            pixel / pinhole_.width(),
            filter_.place(u),
            is_blurred ? in_disk(random.pair(kOnLens)) : dvec2(0)};
}

CameraRays::Place CameraRays::place(uint32_t pixel, uint32_t sample) const {
    if (points_.empty())
        return sampled(pixel, sampling_.first_sample + sample);
    const dvec2& at = points_[size_t(pixel) * samples_ + sample];
    const glm::uvec2 in = pixel_at(pinhole_, at);
    return {pixel, sample, in.x, in.y, at - dvec2(in), dvec2(0)};
}

void CameraRays::make(uint64_t first, size_t count, RayList<Path>& paths) const {
    assert(first + count <= size());
    const size_t before = paths.size();
    paths.resize(before + count);
    parallel_for(count, kCameraGrain, [&](size_t from, size_t to) {
        size_t number = size_t((first + from) / samples_); // of the pixel
        auto sample = uint32_t((first + from) % samples_);
        for (size_t i = from; i < to; ++i) {
            const Place at = place(order_[number], sample);
            if (++sample == samples_) {
                sample = 0;
                ++number;
            }
            // Made where it stays: a copy would wait for the stores before it.
            new (&paths.rays[before + i])
                Ray(pinhole_.ray(at.x, at.y, at.within, at.lens, at.sample));
            paths.skip[before + i] = TriangleId();
            paths.purposes[before + i] = {
                at.pixel, at.sample, 0, RayKind::Camera, false, false, vec3(1), 0, 0, cone_};
        }
    });
}

} // namespace ovc
