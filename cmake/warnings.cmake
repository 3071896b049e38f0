# SPDX-License-Identifier: Apache-2.0
# ovc_flags: the compiler's options for every target of ours; they link it PRIVATE.
add_library(ovc_flags INTERFACE)
target_compile_options(ovc_flags INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wno-missing-field-initializers
    # The edge functions of core/exact/triangle.h stay antisymmetric only when products and sums
    # round separately.
    -ffp-contract=off
    $<$<BOOL:${OVC_WERROR}>:-Werror>)
target_include_directories(ovc_flags INTERFACE ${PROJECT_SOURCE_DIR})
if(OVC_SANITIZE)
    add_compile_options(
        -fsanitize=${OVC_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=undefined)
    add_link_options(-fsanitize=${OVC_SANITIZE})
endif()
