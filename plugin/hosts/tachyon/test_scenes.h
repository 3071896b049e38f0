// SPDX-License-Identifier: Apache-2.0
// Scenes in Tachyon's language for tests: balls of triangles among objects that are none.
#pragma once

#include <string>

namespace ovc::tachyon {

enum class Kind { Flat, Smooth, Colored }; // TRI, STRI, VCSTRI

/// A ball of 2 * 16 * 7 triangles, as a part of a scene.
std::string ball(Kind kind, const std::string& texture, double x, double y, double z,
                 double radius);

/// A scene of 64 x 64 pixels with the textures plain, glass, mirror and checker, a floor that is a
/// plane, a sphere, two lights, and `parts`; `settings` come before the camera.
std::string scene(const std::string& parts, const std::string& settings = "",
                  const std::string& projection = "PROJECTION PERSPECTIVE ZOOM 1.2",
                  int antialiasing = 0);

} // namespace ovc::tachyon
