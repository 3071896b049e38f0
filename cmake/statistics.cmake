# SPDX-License-Identifier: Apache-2.0
# Reads the fields of ovc_statistics from plugin/overcast.h. C++ gets statistics_fields.inc with a
# line OVC_STATISTIC(name, counts up) for each, Python the list OVC_STATISTICS_PYTHON.
block(PROPAGATE OVC_STATISTICS_PYTHON)
    set(header ${PROJECT_SOURCE_DIR}/plugin/overcast.h)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${header})
    file(READ ${header} text)
    string(REGEX MATCH "typedef struct ovc_statistics {.*} ovc_statistics;" text "${text}")
    string(REPLACE ";" "<end>" text "${text}")
    string(REGEX MATCHALL "/\\* [+]? ?[^/]*\\*/[ \n]*(uint64_t|double) [a-z0-9_]+<end>" fields
           "${text}")

    set(lines "")
    set(OVC_STATISTICS_PYTHON "")
    foreach(field ${fields})
        string(REGEX MATCH "(uint64|double)(_t)? ([a-z0-9_]+)<end>$" found "${field}")
        set(type ${CMAKE_MATCH_1})
        set(name ${CMAKE_MATCH_3})
        string(REGEX MATCH "^/\\* [+]" counts_up "${field}")
        string(APPEND lines "OVC_STATISTIC(${name}, $<BOOL:${counts_up}>)\n")
        string(APPEND OVC_STATISTICS_PYTHON "    (\"${name}\", \"c_${type}\"),\n")
    endforeach()
    file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/statistics/statistics_fields.inc CONTENT "${lines}")
endblock()
