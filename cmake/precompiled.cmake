# SPDX-License-Identifier: Apache-2.0
# ovc_precompile(TARGET HEADERS…): the compiler parses these headers, and those that nearly every
# file includes, once for the target instead of once for each of its files. A build with
# -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON finds includes that a file has forgotten.
function(ovc_precompile target)
    set(headers
        <algorithm> <array> <cmath> <cstdint> <functional> <memory> <optional> <span> <string>
        <string_view> <utility> <vector>
        ${PROJECT_SOURCE_DIR}/core/vec.h ${ARGN})
    list(TRANSFORM headers REPLACE "(.+)" "$<$<COMPILE_LANGUAGE:CXX>:\\1>")
    target_precompile_headers(${target} PRIVATE ${headers})
endfunction()
