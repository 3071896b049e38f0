# SPDX-License-Identifier: Apache-2.0
# Fails when clang-format would change a C++ source. cmake -DFORMAT=… -DROOT=… -P format.cmake
foreach(folder core importers kdtree gpu plugin host testscenes tests)
    file(GLOB_RECURSE found ${ROOT}/${folder}/*.h ${ROOT}/${folder}/*.hpp ${ROOT}/${folder}/*.cpp)
    list(APPEND sources ${found})
endforeach()
# The C header is laid out by hand: its comments stand beside the fields.
list(FILTER sources EXCLUDE REGEX "plugin/overcast\\.h$")
execute_process(COMMAND ${FORMAT} --dry-run --Werror ${sources} RESULT_VARIABLE result)
if(result)
    message(FATAL_ERROR "not formatted: run ${FORMAT} -i on the files above")
endif()
