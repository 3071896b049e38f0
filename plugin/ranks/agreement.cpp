// SPDX-License-Identifier: Apache-2.0
// Agrees by way of rank 0, which compares what all ranks bring with what it brings itself.
#include "plugin/ranks/agreement.h"

#include "core/text/format_text.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

namespace ovc {
namespace {

bool always() {
    return true;
}

template <class T>
std::span<const std::byte> bytes_of_value(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    return std::as_bytes(std::span(&value, 1));
}

template <class T>
T value_of(std::span<const std::byte> bytes) {
    T value;
    std::memcpy(&value, bytes.data(), sizeof(value));
    return value;
}

void take_smaller(RankTerms::Own& all, const RankTerms::Own& one) {
    all.gpu_bytes = std::min(all.gpu_bytes, one.gpu_bytes);
    all.host_bytes = std::min(all.host_bytes, one.host_bytes);
    all.pool_bytes = std::min(all.pool_bytes, one.pool_bytes);
    all.buffer_bytes = std::min(all.buffer_bytes, one.buffer_bytes);
    all.has_saved = std::min(all.has_saved, one.has_saved);
}

std::string why_refused(const Transport& transport, uint32_t rank, const RankTerms::Alike& first,
                        const RankTerms::Alike& other) {
    const std::string one = transport.name_of(rank), zero = transport.name_of(0);
    if (other.meshes != first.meshes || other.triangles != first.triangles)
        return format_text("{} has {} triangles in {} meshes, and {} has {} in {}: all ranks of a "
                           "scene need the same meshes",
                           one, other.triangles, other.meshes, zero, first.triangles, first.meshes);
    if (other.soup != first.soup)
        return format_text("{} has other positions, transforms or masks than {}: all ranks of a "
                           "scene need the same meshes",
                           one, zero);
    return format_text("{} has a config other than that of {}: ranks_own, precision, leaves and "
                       "leaf_triangles must be the same on all ranks of a scene",
                       one, zero);
}

} // namespace

Result<RankTerms::Own> agreed_terms(Notes& notes, const Transport& transport,
                                    const RankTerms& mine) {
    RankTerms::Own all = mine.own;
    std::string refused;
    const Result<Done> gathered = notes.gather(
        bytes_of_value(mine), always, [&](uint32_t rank, std::span<const std::byte> note) {
            const auto of_rank = value_of<RankTerms>(note);
            take_smaller(all, of_rank.own);
            if (of_rank.alike != mine.alike && refused.empty())
                refused = why_refused(transport, rank, mine.alike, of_rank.alike);
        });
    if (!gathered)
        return gathered.error();
    std::vector<std::byte> told;
    for (const auto part : {bytes_of_value(all), std::as_bytes(std::span(refused))})
        told.insert(told.end(), part.begin(), part.end());
    const Result<Done> spread =
        notes.spread(told, always, [&](uint32_t, std::span<const std::byte> note) {
            all = value_of<RankTerms::Own>(note);
            const auto text = note.subspan(sizeof(all));
            refused.assign(reinterpret_cast<const char*>(text.data()), text.size());
        });
    if (!spread)
        return spread.error();
    if (!refused.empty())
        return Error{refused, ErrorKind::InvalidArgument};
    return all;
}

Result<Done> check_shares(Notes& notes, const Transport& transport, uint64_t shares) {
    uint64_t first = 0;
    const Result<Done> spread = notes.spread(
        bytes_of_value(shares), always,
        [&](uint32_t, std::span<const std::byte> note) { first = value_of<uint64_t>(note); });
    if (!spread || first == shares)
        return spread;
    return Error{
        format_text("the leaves of this rank, or those that it leaves to others, are not as "
                    "on {}: all ranks of a scene need the same meshes, sample and saved "
                    "levels, and room for their pages on the GPU",
                    transport.name_of(0)),
        ErrorKind::InvalidArgument};
}

} // namespace ovc
