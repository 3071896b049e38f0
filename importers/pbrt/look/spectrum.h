// SPDX-License-Identifier: Apache-2.0
// Spectra as linear sRGB: what a colour parameter says, in whatever words.
#pragma once

#include "importers/pbrt/interpret/parameters.h"

namespace ovc::pbrt {

/// Of light or reflectance: rgb; xyz; a black body's temperature in kelvin, and in v2 and v3 a
/// scale; a spectrum as pairs of wavelength in nm and value, or one value for all. Nothing where it
/// is a spectrum's name or file.
std::optional<vec3> color_of(const Parameter& parameter);

/// A black body of luminance 1.
vec3 black_body(double kelvin);

/// A spectrum of pairs (nm, value), linear in between and constant beyond: seen in white light, so
/// that 1 everywhere is white.
vec3 color_of_samples(std::span<const double> pairs);

/// A metal seen head on, by its name in pbrt ("metal-Au-eta", "spds/Au.k.spd"); nothing where that
/// is not known.
std::optional<vec3> metal_color(std::string_view name);
/// The same from eta and k.
vec3 metal_color(const vec3& eta, const vec3& k);

/// "glass-BK7" and its like; nothing where it is not known.
std::optional<double> glass_ior(std::string_view name);

} // namespace ovc::pbrt
