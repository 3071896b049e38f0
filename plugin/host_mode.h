// SPDX-License-Identifier: Apache-2.0
// The floating-point mode of a host's thread while the library has its own.
#pragma once

#include <cfenv>

namespace ovc {

/// Made before the library sets its mode (DefaultFloatMode), to call functions of the host later in
/// the mode that the host had, and may change there.
class HostFloatMode {
public:
    HostFloatMode() { std::fegetenv(&mode_); }

    template <class Function>
    auto call(Function&& function) {
        std::fesetenv(&mode_);
        const auto value = function();
        std::fegetenv(&mode_);
        std::fesetenv(FE_DFL_ENV);
        return value;
    }

private:
    std::fenv_t mode_;
};

} // namespace ovc
