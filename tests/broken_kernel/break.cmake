# SPDX-License-Identifier: Apache-2.0
# Copies triangle.glsl with its edge test off by a thousandth of the triangle.
# cmake -DIN=… -DOUT=… -P break.cmake
file(READ ${IN} text)
set(right "precise float e = a.x * b.y - a.y * b.x;")
set(wrong "precise float e = a.x * b.y - a.y * b.x - 1.0e-3 * a.size * b.size;")
string(REPLACE "${right}" "${wrong}" broken "${text}")
if(broken STREQUAL text)
    message(FATAL_ERROR "${IN} has no line '${right}' to break")
endif()
file(WRITE ${OUT} "${broken}")
