# SPDX-License-Identifier: Apache-2.0
# ovc_add_tests(FOLDER LABELS … SOURCES … LIBRARIES …): one test program per folder; ctest knows
# each of its tests by name and by the folder's label.
if(OVC_TESTS)
    enable_testing()
    find_package(GTest REQUIRED)
    include(GoogleTest)
endif()

function(ovc_add_tests folder)
    if(NOT OVC_TESTS)
        return()
    endif()
    cmake_parse_arguments(ARG "" "" "LABELS;SOURCES;LIBRARIES" ${ARGN})
    add_executable(${folder}_test ${ARG_SOURCES})
    # What tests promise is said by the libraries' code, so their own is optimised less: -O3 takes
    # half as long again to compile.
    target_compile_options(${folder}_test PRIVATE $<$<CONFIG:Release>:-O1>)
    target_link_libraries(${folder}_test
        PRIVATE ovc_flags ${ARG_LIBRARIES} GTest::gmock GTest::gtest_main)
    target_compile_definitions(${folder}_test PRIVATE OVC_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                                                      OVC_BINARY_DIR="${PROJECT_BINARY_DIR}")
    # The labels are joined into one, because gtest_discover_tests (CMake 3.25) takes no list;
    # ctest -L matches a part of it.
    list(JOIN ARG_LABELS ":" labels)
    if(labels)
        set(labels "${folder}:${labels}")
    else()
        set(labels ${folder})
    endif()
    gtest_discover_tests(${folder}_test
        DISCOVERY_TIMEOUT 60 PROPERTIES LABELS "${labels}" TIMEOUT 1200)
endfunction()
