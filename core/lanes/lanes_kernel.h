// SPDX-License-Identifier: Apache-2.0
// What the sources of all functions by lanes share. Everything here is inlined into the file that
// is compiled for a width of vectors: see hit_lanes_kernel.h.
#pragma once

#include "core/exact/double_double.h"

#include <cstdint>

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
OVC_INLINE WordsOf<V> words_of(V x) {
    WordsOf<V> words;
    __builtin_memcpy(&words, &x, sizeof(V));
    return words;
}
template <class V>
OVC_INLINE V all_lanes(double x) {
    return V{} + x;
}

/// Returns a bit for each lane that is true.
template <class V>
OVC_INLINE uint32_t bits_of(MaskOf<V> mask) {
    return Lanes<V>::bits(mask);
}

} // namespace ovc
