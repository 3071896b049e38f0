# SPDX-License-Identifier: Apache-2.0
# The hardening that Debian asks of its packages (dpkg-buildflags, hardening=+bindnow): address
# tables that become read-only before main, a guard behind arrays on the stack, checked copies.
# Builds with sanitizers go without it: sanitizers find more, but only in the unchecked calls.
include(CheckCXXSourceCompiles)

if(NOT OVC_SANITIZE AND NOT OVC_FUZZ)
    target_compile_options(ovc_flags INTERFACE -fstack-protector-strong)
    target_link_options(ovc_flags INTERFACE -Wl,-z,relro -Wl,-z,now)
    # Checked copies need optimisation. A distribution may have set a level already, by a flag or in
    # its compiler; then we keep that one.
    set(CMAKE_REQUIRED_FLAGS -O2)
    check_cxx_source_compiles("#ifdef _FORTIFY_SOURCE\n#error\n#endif\nint main() {}"
        OVC_SETS_FORTIFY_SOURCE)
    unset(CMAKE_REQUIRED_FLAGS)
    if(OVC_SETS_FORTIFY_SOURCE)
        target_compile_definitions(ovc_flags INTERFACE $<$<NOT:$<CONFIG:Debug>>:_FORTIFY_SOURCE=2>)
    endif()
endif()
