// SPDX-License-Identifier: Apache-2.0
// The sources of all functions by lanes share this. Everything here is inlined into the file that
// is compiled for a width of vectors: see hit_lanes_kernel.h.
#pragma once

#include "core/exact/double_double.h"
#include "core/ray.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

namespace ovc {

template <class V>
OVC_INLINE V load(const double* from) {
    V lanes;
    __builtin_memcpy(&lanes, from, sizeof(V));
    return lanes;
}

/// True (all bits) or false (none), by lanes.
template <class V>
using MaskOf = decltype(V{} < V{});
/// Integers modulo 2^64, by lanes. GCC knows no such template without a structure around it.
template <class V>
struct WordsType {
    typedef unsigned long long Type __attribute__((vector_size(sizeof(V))));
};
template <class V>
using WordsOf = typename WordsType<V>::Type;

template <class V>
OVC_INLINE V smaller(V a, V b) {
    return a < b ? a : b;
}
template <class V>
OVC_INLINE V larger(V a, V b) {
    return a > b ? a : b;
}
template <class V>
OVC_INLINE V magnitude(V x) {
    return Lanes<V>::magnitude(x);
}
template <class V>
OVC_INLINE MaskOf<V> are_finite(V x) {
    return magnitude(x) <= std::numeric_limits<double>::max();
}
template <class V>
OVC_INLINE WordsOf<V> words_of(V x) {
    WordsOf<V> words;
    __builtin_memcpy(&words, &x, sizeof(V));
    return words;
}
template <class V>
OVC_INLINE V all_lanes(double x) {
    return V{} + x;
}

template <size_t d, class V, size_t... k>
OVC_INLINE void swap_blocks(V& a, V& b, std::index_sequence<k...>) {
    constexpr size_t n = sizeof...(k);
    const V low = __builtin_shufflevector(a, b, int(k & d ? n + k - d : k)...);
    const V high = __builtin_shufflevector(a, b, int(k & d ? n + k : k + d)...);
    a = low;
    b = high;
}
/// Turns rows into columns: element k of vector i becomes element i of vector k. There are as many
/// vectors as elements in one. By blocks of d, then of twice as many.
template <size_t d = 1, class V, size_t n>
OVC_INLINE void transpose(V (&rows)[n]) {
    if constexpr (d < n) {
        for (size_t i = 0; i < n; ++i)
            if ((i & d) == 0)
                swap_blocks<d>(rows[i], rows[i + d], std::make_index_sequence<n>());
        transpose<2 * d>(rows);
    }
}

/// Loads a ray for each element of V. Column i of the eight holds double i of each.
template <class V>
OVC_INLINE void load_rays(const Ray* const* rays, V (&columns)[8]) {
    constexpr int n = int(sizeof(V) / sizeof(double));
    for (int column = 0; column < 8; column += n) {
        V rows[n];
        for (int i = 0; i < n; ++i)
            rows[i] = load<V>(reinterpret_cast<const double*>(rays[i]) + column);
        transpose(rows);
        for (int i = 0; i < n; ++i)
            columns[column + i] = rows[i];
    }
}

/// Returns a bit for each lane that is true.
template <class V>
OVC_INLINE uint32_t bits_of(MaskOf<V> mask) {
    return Lanes<V>::bits(mask);
}

} // namespace ovc
