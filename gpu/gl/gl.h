// SPDX-License-Identifier: Apache-2.0
// OpenGL and EGL, through libepoxy. No other file includes <epoxy/…>.
#pragma once

#include <epoxy/egl.h>
#include <epoxy/gl.h>
