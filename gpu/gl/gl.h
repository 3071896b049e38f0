// SPDX-License-Identifier: Apache-2.0
// OpenGL and EGL, through libepoxy. Nobody else includes <epoxy/…>.
#pragma once

#include <epoxy/egl.h>
#include <epoxy/gl.h>
