// SPDX-License-Identifier: Apache-2.0
// The floating-point mode of a thread: the library's own inside a call, the host's outside of it
// and in its functions.
#pragma once

#if defined(__SSE2__)
#include <xmmintrin.h>
#else
#include <cfenv>
#endif

namespace ovc {

#if defined(__SSE2__)
/// MXCSR: nothing of ours is computed in x87 registers, and <cfenv>, which saves those as well,
/// would take a tenth of the time of a single ray.
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

/// The host's mode replaced by the default while this lives: proofs about rounding hold in no
/// other.
class DefaultFloatMode {
public:
    DefaultFloatMode() { set_default_float_mode(); }
    ~DefaultFloatMode() { set_float_mode(host_); }
    DefaultFloatMode(const DefaultFloatMode&) = delete;

private:
    const FloatMode host_ = float_mode();
};

/// Made before the library sets its mode, to call functions of the host in the mode that the host
/// had, and may change there.
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
