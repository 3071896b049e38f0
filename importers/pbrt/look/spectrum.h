// SPDX-License-Identifier: Apache-2.0
// The color of a parameter as linear sRGB, in whatever way the file states it.
#pragma once

#include "importers/pbrt/interpret/parameters.h"

namespace ovc::pbrt {

/// Returns a color of light or reflectance. The parameter may be a number; rgb; xyz; a black
/// body's temperature in kelvin, of luminance 1, and in v2 and v3 a scale of a spectrum that is 1
/// at its peak; or a spectrum as pairs of wavelength in nm and value, or one value for all. Returns
/// nothing for a spectrum's name or file, and for too few numbers. is_v4: as in color_of_samples().
std::optional<vec3> color_of(const Parameter& parameter, bool is_v4);

/// Returns the color of a spectrum of v4's lights, of luminance 1: pairs of wavelength and value,
/// or an illuminant's name; nothing if it is not known.
std::optional<vec3> illuminant(const Parameter& parameter);

/// Returns the color of a black body of luminance 1.
vec3 black_body(double kelvin);

/// Returns the color of white light on a film to which daylight of so many kelvins is white.
vec3 white_balance(double kelvin);

/// Returns the color of a spectrum of pairs (nm, value), at least one, which is linear in between,
/// as seen in white light: 1 everywhere is white. Before v4 the light is the same at all
/// wavelengths, and the spectrum constant beyond its ends; in v4 the light is D65, and it is 0
/// there.
vec3 color_of_samples(std::span<const double> pairs, bool is_v4);

/// Returns the color of a metal seen head on, by its name in pbrt ("metal-Au-eta",
/// "spds/Au.k.spd"); nothing if the name is not known.
std::optional<vec3> metal_color(std::string_view name);
/// Returns the same from eta and k.
vec3 metal_color(const vec3& eta, const vec3& k);
/// Return the same below a smooth coat, with the light that this reflects: of index 1.5 for a metal
/// by its name, else of index `coat`.
std::optional<vec3> coated_metal_color(std::string_view name);
vec3 coated_metal_color(const vec3& eta, const vec3& k, double coat);

/// Returns the index of refraction of "glass-BK7" and its like; nothing if the name is not known.
std::optional<double> glass_ior(std::string_view name);

} // namespace ovc::pbrt
