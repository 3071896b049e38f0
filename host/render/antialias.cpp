// SPDX-License-Identifier: Apache-2.0
#include "host/render/antialias.h"

#include "core/system/parallel.h"
#include "host/camera/camera.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <iterator>
#include <unordered_map>
#include <utility>

namespace ovc {
namespace {

constexpr size_t kMaxPoints = size_t(1) << 21; // in one call, to bound memory
constexpr size_t kPixelGrain = 4096;           // pixels a task
constexpr size_t kTile = 16; // pixels across, of tiles whose rays are traced together

/// Returns a pseudo-random point in [-0.5, 0.5)^2 that depends on the numbers alone.
/// Hash: Steele, Lea and Flood 2014, SplitMix64.
dvec2 chance(uint64_t a, uint64_t b) {
    uint64_t bits = a * 0x9e3779b97f4a7c15u + b;
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
    bits ^= bits >> 31;
    return dvec2(double(bits >> 32), double(bits & 0xffffffffu)) * 0x1p-32 - 0.5;
}

/// How bright light looks, by POV-Ray's Antialias_Gamma, 2.5. Each sample asks for three powers:
/// those of common light lie in a table, between whose entries the error is below 2e-6 of them.
class Brightness {
public:
    /// gamma: of the scene.
    explicit Brightness(double gamma) : gamma_(gamma) {
        for (uint32_t i = 0; i <= kEntries; ++i)
            table_[i] = power(std::bit_cast<float>(kFirst + (i << kShareBits)));
    }

    float of(float light) const {
        const uint32_t bits = std::bit_cast<uint32_t>(light) - kFirst;
        const uint32_t entry = bits >> kShareBits;
        if (entry >= kEntries) // negative light, too
            return power(light);
        const float share = float(bits & ((1u << kShareBits) - 1)) / float(1u << kShareBits);
        return table_[entry] + share * (table_[entry + 1] - table_[entry]);
    }

private:
    static constexpr uint32_t kFirst = std::bit_cast<uint32_t>(0x1p-12f);
    static constexpr uint32_t kShareBits = 16; // the low bits of a float's mantissa
    static constexpr uint32_t kEntries = (std::bit_cast<uint32_t>(16.0f) - kFirst) >> kShareBits;

    float power(float light) const {
        if (!(light > 0))
            return 0;
        return gamma_ == kSrgbGamma ? std::pow(linear_light(light, gamma_), 1 / 2.5f)
                                    : std::pow(light, float(gamma_ / 2.5));
    }

    const double gamma_;
    std::array<float, kEntries + 1> table_;
};

/// Returns how bright the components of a color look.
vec3 looks_of(const vec3& light, const Brightness& brightness) {
    return {brightness.of(light.x), brightness.of(light.y), brightness.of(light.z)};
}

/// Compares colors by how bright they look.
bool looks_differ(const vec3& a, const vec3& b, float threshold) {
    const vec3 off = glm::abs(a - b);
    return off.x + off.y + off.z >= threshold;
}

class Supersampling {
public:
    Supersampling(const Antialias& how, double gamma, SampleTracer& tracer, Film& film)
        : size_{film.width(), film.height()},
          how_(how),
          brightness_(gamma),
          tracer_(tracer),
          film_(film),
          looks_(size_t(size_.width) * size_.height),
          refined_(looks_.size()) {}

    bool run() {
        if (!tracer_.trace_middles(film_))
            return false;
        in_rows([&](size_t y) {
            for (size_t i = y * size_.width; i < (y + 1) * size_.width; ++i)
                look_at(uint32_t(i));
        });
        // A refined pixel may still differ from a neighbour that is not refined. POV-Ray refines
        // that one in the same round, we do so in the next.
        for (std::vector<uint32_t> pixels = rough(); !pixels.empty(); pixels = rough_beside(pixels))
            if (!refine(pixels))
                return false;
        return true;
    }

private:
    /// Returns the pixels that differ from a neighbour, tile by tile.
    std::vector<uint32_t> rough() const {
        const size_t w = size_.width, h = size_.height;
        enum : uint8_t { kRight = 1, kBelow = 2 }; // the neighbours that a pixel differs from
        std::vector<uint8_t> differs(w * h), is_rough(w * h);
        in_rows([&](size_t y) {
            for (size_t x = 0, i = y * w; x < w; ++x, ++i)
                differs[i] = uint8_t((x + 1 < w && differ(i, i + 1) ? kRight : 0) |
                                     (y + 1 < h && differ(i, i + w) ? kBelow : 0));
        });
        in_rows([&](size_t y) {
            for (size_t x = 0, i = y * w; x < w; ++x, ++i)
                is_rough[i] = differs[i] || (x > 0 && differs[i - 1] & kRight) ||
                              (y > 0 && differs[i - w] & kBelow);
        });
        std::vector<uint32_t> pixels;
        for (size_t top = 0; top < h; top += kTile)
            for (size_t left = 0; left < w; left += kTile)
                for (size_t y = top; y < std::min(top + kTile, h); ++y)
                    for (size_t x = left; x < std::min(left + kTile, w); ++x)
                        if (is_rough[y * w + x])
                            pixels.push_back(uint32_t(y * w + x));
        return pixels;
    }

    /// Calls row(y) for each row of the picture, in parallel.
    template <class Row>
    void in_rows(Row row) const {
        parallel_for(size_.height, kPixelGrain / size_.width + 1, [&](size_t first, size_t last) {
            for (size_t y = first; y < last; ++y)
                row(y);
        });
    }

    /// Returns the pixels of one sample that differ from one of these, beside it.
    std::vector<uint32_t> rough_beside(const std::vector<uint32_t>& refined) const {
        const size_t w = size_.width;
        std::vector<uint32_t> pixels;
        const auto compare = [&](size_t i, size_t other) {
            if (!refined_[other] && differ(i, other))
                pixels.push_back(uint32_t(other));
        };
        for (const size_t i : refined) {
            if (i % w > 0)
                compare(i, i - 1);
            if (i % w + 1 < w)
                compare(i, i + 1);
            if (i >= w)
                compare(i, i - w);
            if (i + w < looks_.size())
                compare(i, i + w);
        }
        std::ranges::sort(pixels);
        const auto twice = std::ranges::unique(pixels);
        pixels.erase(twice.begin(), twice.end());
        return pixels;
    }

    bool differ(size_t i, size_t other) const {
        return looks_differ(looks_[i], looks_[other], how_.threshold);
    }

    /// Adds depth x depth samples to each of the pixels.
    bool refine(const std::vector<uint32_t>& pixels) {
        const size_t samples = size_t(how_.depth) * how_.depth;
        const size_t pixels_at_once = std::max<size_t>(kMaxPoints / samples, 1);
        for (size_t first = 0; first < pixels.size(); first += pixels_at_once) {
            const size_t count = std::min(pixels_at_once, pixels.size() - first);
            points_.resize(count * samples);
            light_.resize(count);
            parallel_for(count, kPixelGrain / samples, [&](size_t from, size_t to) {
                for (size_t i = from; i < to; ++i)
                    place_samples(pixels[first + i], std::span(points_).subspan(i * samples));
            });
            if (!tracer_.trace_points(points_, light_))
                return false;
            add(std::span(pixels).subspan(first, count), samples);
        }
        return true;
    }

    /// Sets the first of `points` to the places of the pixel's further samples.
    void place_samples(uint32_t pixel, std::span<dvec2> points) const {
        const uint32_t side = how_.depth;
        for (uint32_t y = 0, sample = 0; y < side; ++y)
            for (uint32_t x = 0; x < side; ++x, ++sample) {
                const dvec2 off = 0.5 + double(how_.jitter) * chance(pixel, sample);
                points[sample] = dvec2(pixel % size_.width, pixel / size_.width) +
                                 (dvec2(x, y) + off) / double(side);
            }
    }

    /// Adds light_, each of which is the mean of so many samples, to these pixels.
    void add(std::span<const uint32_t> pixels, size_t samples) {
        std::vector<Film::Sums> sums(pixels.size());
        parallel_for(pixels.size(), kPixelGrain, [&](size_t first, size_t last) {
            for (size_t i = first; i < last; ++i) {
                const dvec3 sum = film_.mean(pixels[i]) + double(samples) * dvec3(light_[i]);
                sums[i] = film_.sums_of(vec3(sum / double(samples + 1)));
                refined_[pixels[i]] = true;
            }
        });
        film_.restore(pixels, sums);
        parallel_for(pixels.size(), kPixelGrain, [&](size_t first, size_t last) {
            for (const uint32_t pixel : pixels.subspan(first, last - first))
                look_at(pixel);
        });
    }

    void look_at(uint32_t pixel) { looks_[pixel] = looks_of(vec3(film_.mean(pixel)), brightness_); }

    const ImageSize size_;
    const Antialias how_;
    const Brightness brightness_;
    SampleTracer& tracer_;
    Film& film_;
    std::vector<vec3> looks_; // of the pixels
    std::vector<uint8_t> refined_;
    std::vector<dvec2> points_; // of one call, whose memory the next takes
    std::vector<vec3> light_;
};

/// A square with a sample at each corner, on a grid of 2^(depth - 1) cells a pixel.
struct Cell {
    uint64_t x, y;
    uint32_t size;
};

/// The light of a sample, and how bright it looks.
struct Seen {
    vec3 light{0}, looks{0};
};

class Subdivision {
public:
    Subdivision(const Antialias& how, double gamma, SampleTracer& tracer, Film& film)
        : size_{film.width(), film.height()},
          how_(how),
          brightness_(gamma),
          tracer_(tracer),
          film_(film),
          cells_(1u << (how.depth - 1)),
          columns_(uint64_t(size_.width) * cells_ + 1) {}

    bool run() {
        std::vector<Cell> cells;
        for (const uint32_t pixel : pixel_order(size_.width, size_.height))
            cells.push_back(cell_of(pixel));
        for (const Cell& cell : cells)
            want(cell);
        while (!cells.empty()) {
            if (!sample_wanted())
                return false;
            std::vector<Cell> quarters;
            for (const Cell& cell : cells)
                if (is_divided(cell))
                    for_each_quarter(cell,
                                     [&](const Cell& quarter) { quarters.push_back(quarter); });
            for (const Cell& quarter : quarters)
                want(quarter);
            cells = std::move(quarters);
        }
        parallel_for(size_t(size_.width) * size_.height, kPixelGrain,
                     [&](size_t first, size_t last) {
                         Film::Answers answers(film_);
                         for (size_t i = first; i < last; ++i)
                             answers.close(uint32_t(i), mean(cell_of(uint32_t(i))));
                     });
        return true;
    }

private:
    Cell cell_of(uint32_t pixel) const {
        return {uint64_t(pixel % size_.width) * cells_, uint64_t(pixel / size_.width) * cells_,
                cells_};
    }
    uint64_t key(uint64_t x, uint64_t y) const { return y * columns_ + x; }

    /// Adds the corners of the square that have no sample yet to wanted_.
    void want(const Cell& cell) {
        for (const uint64_t y : {cell.y, cell.y + cell.size})
            for (const uint64_t x : {cell.x, cell.x + cell.size})
                if (samples_.try_emplace(key(x, y)).second)
                    wanted_.push_back(key(x, y));
    }

    bool sample_wanted() {
        std::vector<dvec2> points;
        std::vector<vec3> light;
        for (size_t first = 0; first < wanted_.size(); first += points.size()) {
            points.resize(std::min(kMaxPoints, wanted_.size() - first));
            light.resize(points.size());
            for (size_t i = 0; i < points.size(); ++i) {
                const uint64_t at = wanted_[first + i];
                const dvec2 off = double(how_.jitter) * chance(at, 0);
                const dvec2 point =
                    (dvec2(double(at % columns_), double(at / columns_)) + off) / double(cells_);
                points[i] = glm::clamp(point, dvec2(0), dvec2(size_.width, size_.height));
            }
            if (!tracer_.trace_points(points, light))
                return false;
            for (size_t i = 0; i < points.size(); ++i)
                samples_[wanted_[first + i]] = {light[i], looks_of(light[i], brightness_)};
        }
        wanted_.clear();
        return true;
    }

    std::array<Seen, 4> corners(const Cell& cell) const {
        const auto at = [&](uint64_t x, uint64_t y) { return samples_.at(key(x, y)); };
        const uint64_t right = cell.x + cell.size, below = cell.y + cell.size;
        return {at(cell.x, cell.y), at(right, cell.y), at(cell.x, below), at(right, below)};
    }

    bool is_divided(const Cell& cell) const {
        if (cell.size == 1)
            return false;
        const std::array<Seen, 4> c = corners(cell);
        const auto apart = [&](int i, int k) {
            return looks_differ(c[size_t(i)].looks, c[size_t(k)].looks, how_.threshold);
        };
        return apart(0, 1) || apart(2, 3) || apart(0, 2) || apart(1, 3) || apart(0, 3) ||
               apart(1, 2);
    }

    template <class Use>
    static void for_each_quarter(const Cell& cell, Use use) {
        const uint32_t half = cell.size / 2;
        for (const uint64_t y : {cell.y, cell.y + half})
            for (const uint64_t x : {cell.x, cell.x + half})
                use(Cell{x, y, half});
    }

    vec3 mean(const Cell& cell) const {
        vec3 sum(0);
        if (is_divided(cell))
            for_each_quarter(cell, [&](const Cell& quarter) { sum += mean(quarter); });
        else
            for (const Seen& corner : corners(cell))
                sum += corner.light;
        return sum / 4.0f;
    }

    const ImageSize size_;
    const Antialias how_;
    const Brightness brightness_;
    SampleTracer& tracer_;
    Film& film_;
    const uint32_t cells_; // per pixel, along each side
    const uint64_t columns_;
    std::unordered_map<uint64_t, Seen> samples_; // by key()
    std::vector<uint64_t> wanted_;
};

} // namespace

bool antialias(const Antialias& how, double gamma, SampleTracer& tracer, Film& film) {
    assert(how.depth >= 1 && how.depth <= kMaxAntialiasDepth && film.samples() == 1);
    Film picture(film.width(), film.height()); // which is not to be seen before it is done
    const bool done = how.method == Antialias::Method::Supersample
                          ? Supersampling(how, gamma, tracer, picture).run()
                          : Subdivision(how, gamma, tracer, picture).run();
    if (done)
        film.take(std::move(picture));
    return done;
}

} // namespace ovc
