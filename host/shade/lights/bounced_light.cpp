// SPDX-License-Identifier: Apache-2.0
#include "host/shade/lights/bounced_light.h"

#include "core/box.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>

namespace ovc {

namespace {

/// The light is the mean of so many records, the nearest ones that face about the same way. More
/// hide the noise of each, and blur shadows.
constexpr size_t kNearest = 12;
/// Records count whose normals are within about 37 degrees, the more the less they differ.
constexpr double kMinCosine = 0.8;
/// A record beside the surface's plane counts as so many times farther away.
constexpr double kBeside = 4;

/// The nearest records found so far, the farthest of them first.
class NearRecords {
public:
    double limit() const { return count_ < ptrdiff_t(kNearest) ? kNoLimit : entries_[0].square; }

    void offer(double square, const BouncedLight::Record& record) {
        if (square >= limit())
            return;
        if (count_ == ptrdiff_t(kNearest))
            std::pop_heap(entries_.begin(), entries_.begin() + count_--);
        entries_[size_t(count_++)] = {square, &record};
        std::push_heap(entries_.begin(), entries_.begin() + count_);
    }

    /// Returns the mean of the records; nothing was found where `weights` stays 0.
    vec3 mean(const dvec3& normal, double& weights) const {
        vec3 sum(0);
        for (size_t i = 0; i < size_t(count_); ++i) {
            const double cosine = glm::dot(normal, entries_[i].record->normal);
            // The farthest one, at the front, fades out before another takes its place.
            const double near = 1 - entries_[i].square / (1.1 * entries_[0].square + 1e-300);
            const double weight = (cosine - kMinCosine) * std::max(near, 1e-3);
            sum += float(weight) * entries_[i].record->light;
            weights += weight;
        }
        return weights > 0 ? sum / float(weights) : vec3(0);
    }

private:
    static constexpr double kNoLimit = std::numeric_limits<double>::infinity();
    struct Entry {
        double square;
        const BouncedLight::Record* record;
        bool operator<(const Entry& other) const { return square < other.square; }
    };
    std::array<Entry, kNearest> entries_{};
    ptrdiff_t count_ = 0;
};

} // namespace

BouncedLight::BouncedLight(std::vector<Record> records) : records_(std::move(records)) {
    axes_.resize(records_.size());
    build(0, records_.size());
    for (const Record& record : records_)
        mean_ += record.light / float(records_.size());
}

void BouncedLight::build(size_t first, size_t last) {
    if (first >= last)
        return;
    Box box;
    for (size_t i = first; i < last; ++i)
        box.add(records_[i].at);
    const int axis = major_axis(box.extent());
    const size_t middle = first + (last - first) / 2;
    std::nth_element(records_.begin() + ptrdiff_t(first), records_.begin() + ptrdiff_t(middle),
                     records_.begin() + ptrdiff_t(last),
                     [&](const Record& a, const Record& b) { return a.at[axis] < b.at[axis]; });
    axes_[middle] = uint8_t(axis);
    build(first, middle);
    build(middle + 1, last);
}

vec3 BouncedLight::at(const dvec3& place, const dvec3& normal) const {
    struct Range {
        size_t first, last;
        double square; // at least so far away
    };
    NearRecords nearest;
    Range waiting[128]; // halving 2^64 records goes 64 deep
    size_t count = 0;
    waiting[count++] = {0, records_.size(), 0};
    while (count > 0) {
        const Range range = waiting[--count];
        if (range.first >= range.last || range.square >= nearest.limit())
            continue;
        const size_t middle = range.first + (range.last - range.first) / 2;
        const Record& record = records_[middle];
        const dvec3 way = place - record.at;
        if (glm::dot(normal, record.normal) > kMinCosine) {
            const double beside = kBeside * glm::dot(way, record.normal);
            nearest.offer(glm::dot(way, way) + beside * beside, record);
        }
        const double off = way[axes_[middle]];
        const Range low{range.first, middle,
                        off <= 0 ? range.square : std::max(range.square, off * off)};
        const Range high{middle + 1, range.last,
                         off >= 0 ? range.square : std::max(range.square, off * off)};
        assert(count + 2 <= std::size(waiting));
        waiting[count++] = off <= 0 ? high : low; // the nearer half goes first
        waiting[count++] = off <= 0 ? low : high;
    }
    double weights = 0;
    const vec3 mean = nearest.mean(normal, weights);
    return weights > 0 ? mean : mean_;
}

} // namespace ovc
