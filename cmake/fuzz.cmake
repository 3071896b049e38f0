# SPDX-License-Identifier: Apache-2.0
# cmake -DOVC_FUZZ=ON with clang makes the libFuzzer targets fuzz_NAME; docs/design/fuzzing.md says
# how they are run.
option(OVC_FUZZ "Build the libFuzzer targets; needs clang" OFF)
if(OVC_FUZZ AND NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    message(FATAL_ERROR "OVC_FUZZ needs clang: -DCMAKE_CXX_COMPILER=clang++")
endif()
if(OVC_FUZZ) # with assertions, whatever the build type
    string(REPLACE "-DNDEBUG" "" CMAKE_CXX_FLAGS_RELEASE "${CMAKE_CXX_FLAGS_RELEASE}")
    string(REPLACE "-DNDEBUG" "" CMAKE_CXX_FLAGS_RELWITHDEBINFO "${CMAKE_CXX_FLAGS_RELWITHDEBINFO}")
endif()

# ovc_watch_for_fuzzing(TARGET): fuzzers count the coverage of the target's code, and sanitizers
# check it.
function(ovc_watch_for_fuzzing target)
    if(OVC_FUZZ)
        target_compile_options(${target} PRIVATE
            -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined)
    endif()
endfunction()

# ovc_add_fuzzer(NAME SOURCES … LIBRARIES …)
function(ovc_add_fuzzer name)
    cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES;DEFINITIONS" ${ARGN})
    # This also runs without clang, where nothing else would notice that a file was moved.
    foreach(source ${ARG_SOURCES})
        cmake_path(ABSOLUTE_PATH source OUTPUT_VARIABLE path)
        if(NOT source MATCHES "TARGET_OBJECTS" AND NOT EXISTS ${path})
            message(FATAL_ERROR "fuzz_${name}: there is no ${path}")
        endif()
    endforeach()
    if(NOT OVC_FUZZ)
        return()
    endif()
    add_executable(fuzz_${name} ${ARG_SOURCES})
    target_compile_definitions(fuzz_${name} PRIVATE ${ARG_DEFINITIONS})
    target_compile_options(fuzz_${name} PRIVATE
        -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=undefined)
    target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer,address,undefined)
    target_link_libraries(fuzz_${name} PRIVATE ovc_flags ${ARG_LIBRARIES})
endfunction()
