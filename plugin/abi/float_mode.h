// SPDX-License-Identifier: Apache-2.0
// Sets the floating-point mode of a thread: the library's own inside a call, the host's outside of
// calls and in the host's functions.
#pragma once

#if defined(__SSE2__)
#include <xmmintrin.h>
#else
#include <cfenv>
#endif

namespace ovc {

#if defined(__SSE2__)
/// The mode is MXCSR alone: the library computes nothing in x87 registers, and <cfenv>, which saves
/// those as well, would take a tenth of the time of a single ray.
using FloatMode = unsigned;
inline FloatMode float_mode() {
    return _mm_getcsr();
}
/// Looking is cheaper than setting, and mostly there is nothing to set.
inline void set_float_mode(FloatMode mode) {
    if (_mm_getcsr() != mode)
        _mm_setcsr(mode);
}
inline void set_default_float_mode() {
    constexpr FloatMode kRoundToNearestAllMasked = 0x1f80, kFlags = 0x3f;
    if ((_mm_getcsr() & ~kFlags) != kRoundToNearestAllMasked)
        _mm_setcsr(kRoundToNearestAllMasked);
}
#else
using FloatMode = std::fenv_t;
inline FloatMode float_mode() {
    FloatMode mode;
    std::fegetenv(&mode);
    return mode;
}
inline void set_float_mode(const FloatMode& mode) {
    std::fesetenv(&mode);
}
inline void set_default_float_mode() {
    std::fesetenv(FE_DFL_ENV);
}
#endif

/// Replaces the host's mode by the default while it lives, because the proofs about rounding hold
/// in no other mode.
class DefaultFloatMode {
public:
    DefaultFloatMode() { set_default_float_mode(); }
    ~DefaultFloatMode() { set_float_mode(host_); }
    DefaultFloatMode(const DefaultFloatMode&) = delete;

private:
    const FloatMode host_ = float_mode();
};

/// Calls functions of the host in the host's own mode, which they may change. It must be made
/// before the library sets its mode.
class HostFloatMode {
public:
    template <class Function>
    auto call(Function&& function) {
        set_float_mode(mode_);
        const auto value = function();
        mode_ = float_mode();
        set_default_float_mode();
        return value;
    }

private:
    FloatMode mode_ = float_mode();
};

} // namespace ovc
