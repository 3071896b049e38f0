// SPDX-License-Identifier: Apache-2.0
// The part of GLSL that the kernel's sources use, in C++. They compile as they are, except for the
// spelling that glsl_as_cpp.py changes. All arithmetic is in float32, as in the kernel.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib> // abs(int)

namespace glsl {

using uint = uint32_t;

template <class T, int n>
struct Array {
    T items[n];

    Array() = default;
    template <class... Items>
    explicit Array(Items... given) : items{given...} {}
    T& operator[](int i) { return items[i]; }
    const T& operator[](int i) const { return items[i]; }
};

template <class T>
struct Vec2 {
    T x{}, y{};
    Vec2() = default;
    explicit Vec2(T all) : x(all), y(all) {}
    template <class X, class Y>
    Vec2(X x_, Y y_) : x(T(x_)), y(T(y_)) {}
    bool operator==(const Vec2&) const = default;
};

template <class T>
struct Vec3 {
    T x{}, y{}, z{};
    Vec3() = default;
    explicit Vec3(T all) : x(all), y(all), z(all) {}
    template <class X, class Y, class Z>
    Vec3(X x_, Y y_, Z z_) : x(T(x_)), y(T(y_)), z(T(z_)) {}
    template <class Other>
    explicit Vec3(const Vec3<Other>& v) : x(T(v.x)), y(T(v.y)), z(T(v.z)) {}
    Vec2<T> xy() const { return {x, y}; }
    T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
    const T& operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
    bool operator==(const Vec3&) const = default;
};

template <class T>
struct Vec4 {
    T x{}, y{}, z{}, w{};
    Vec4() = default;
    explicit Vec4(T all) : x(all), y(all), z(all), w(all) {}
    template <class X, class Y, class Z, class W>
    Vec4(X x_, Y y_, Z z_, W w_) : x(T(x_)), y(T(y_)), z(T(z_)), w(T(w_)) {}
    template <class Other>
    explicit Vec4(const Vec4<Other>& v) : x(T(v.x)), y(T(v.y)), z(T(v.z)), w(T(v.w)) {}
    Vec2<T> xy() const { return {x, y}; }
    Vec2<T> zw() const { return {z, w}; }
    Vec3<T> xyz() const { return {x, y, z}; }
    Vec4 zwxy() const { return {z, w, x, y}; }
    bool operator==(const Vec4&) const = default;
};

using vec2 = Vec2<float>;
using vec3 = Vec3<float>;
using vec4 = Vec4<float>;
using ivec3 = Vec3<int>;
using ivec4 = Vec4<int>;
using uvec2 = Vec2<uint>;
using uvec3 = Vec3<uint>;
using uvec4 = Vec4<uint>;
using bvec3 = Vec3<bool>;
using bvec4 = Vec4<bool>;

/// Calls f for each component of vectors, of which `like` tells the kind of the result.
template <class R, class F, class A, class... B>
Vec3<R> each(F f, const Vec3<A>& a, const Vec3<B>&... b) {
    return {f(a.x, b.x...), f(a.y, b.y...), f(a.z, b.z...)};
}
template <class R, class F, class A, class... B>
Vec4<R> each(F f, const Vec4<A>& a, const Vec4<B>&... b) {
    return {f(a.x, b.x...), f(a.y, b.y...), f(a.z, b.z...), f(a.w, b.w...)};
}

inline vec2 operator*(vec2 a, float b) {
    return {a.x * b, a.y * b};
}
inline vec3 operator*(vec3 a, float b) {
    return {a.x * b, a.y * b, a.z * b};
}
inline vec3 operator*(vec3 a, vec3 b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
inline vec3 operator-(vec3 a, vec3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline vec3 operator/(float a, vec3 b) {
    return {a / b.x, a / b.y, a / b.z};
}
inline vec4 operator*(vec4 a, float b) {
    return {a.x * b, a.y * b, a.z * b, a.w * b};
}
inline vec4 operator+(vec4 a, float b) {
    return {a.x + b, a.y + b, a.z + b, a.w + b};
}
inline ivec4 operator&(ivec4 a, int b) {
    return {a.x & b, a.y & b, a.z & b, a.w & b};
}
inline ivec4 operator|(ivec4 a, ivec4 b) {
    return {a.x | b.x, a.y | b.y, a.z | b.z, a.w | b.w};
}

inline ivec3 operator>>(ivec3 a, int b) {
    return {a.x >> b, a.y >> b, a.z >> b};
}

inline int floatBitsToInt(float f) {
    return std::bit_cast<int>(f);
}
inline uint floatBitsToUint(float f) {
    return std::bit_cast<uint>(f);
}
inline float uintBitsToFloat(uint u) {
    return std::bit_cast<float>(u);
}
inline float intBitsToFloat(int i) {
    return std::bit_cast<float>(i);
}
inline ivec4 floatBitsToInt(vec4 v) {
    return each<int>([](float f) { return floatBitsToInt(f); }, v);
}
inline vec3 uintBitsToFloat(uvec3 v) {
    return each<float>([](uint u) { return uintBitsToFloat(u); }, v);
}

inline int min(int a, int b) {
    return std::min(a, b);
}
inline int max(int a, int b) {
    return std::max(a, b);
}
inline ivec4 min(ivec4 a, ivec4 b) {
    return each<int>([](int x, int y) { return std::min(x, y); }, a, b);
}
inline ivec4 max(ivec4 a, ivec4 b) {
    return each<int>([](int x, int y) { return std::max(x, y); }, a, b);
}
inline float min(float a, float b) {
    return std::min(a, b);
}
inline float max(float a, float b) {
    return std::max(a, b);
}
inline float abs(float f) {
    return std::fabs(f);
}
inline vec3 abs(vec3 v) {
    return each<float>([](float f) { return std::fabs(f); }, v);
}
inline bvec3 lessThan(vec3 a, vec3 b) {
    return each<bool>([](float x, float y) { return x < y; }, a, b);
}
inline bvec4 lessThan(ivec4 a, ivec4 b) {
    return each<bool>([](int x, int y) { return x < y; }, a, b);
}
inline vec3 mix(vec3 a, vec3 b, bvec3 second) {
    return each<float>([](float x, float y, bool s) { return s ? y : x; }, a, b, second);
}
inline ivec4 mix(ivec4 a, ivec4 b, bvec4 second) {
    return each<int>([](int x, int y, bool s) { return s ? y : x; }, a, b, second);
}

} // namespace glsl
