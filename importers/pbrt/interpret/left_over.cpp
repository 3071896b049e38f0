// SPDX-License-Identifier: Apache-2.0
// Sources: the parameters in the file formats of pbrt-v1 to v4.
#include "importers/pbrt/interpret/left_over.h"

#include "importers/file/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace ovc::pbrt {

namespace {

/// Parameters without a meaning for what is seen: they say how a picture is sampled or stored, or
/// repeat what the data say.
constexpr std::string_view kPassedOver =
    " S aamode coordinatesystem diagonal dirtyregions discarddegenerateUVs display faceIndices "
    "maxanisotropy maxcomponentvalue maxsampleluminance name nsamples "
    "premultiplyalpha preview remaproughness samples savefp16 scheme shutterclose "
    "shutteropen trilinear writefrequency ";

/// Further parameters that pbrt has and that are not shown everywhere.
constexpr std::string_view kOfPbrt =
    " A B B0 B1 C D I K Kd Kr Ks Kt L N P Pw Pz albedo alpha amount anisotropic basis beta_m "
    "beta_n bsdffile bumpmap clearcoat clearcoatgloss color conductor.eta conductor.k "
    "conductor.roughness conductor.uroughness conductor.vroughness coneangle conedeltaangle "
    "cropwindow curvetype degree depth difftrans dimension displacement "
    "displacement.edgelength edgelength emissionfilename encoding eta eumelanin exposuretime "
    "filename "
    "flatness fov frameaspectratio from g gamma halffov height hither illuminance imagefile "
    "index indices innerradius inside interface.eta interface.roughness "
    "interface.thickness interface.uroughness interface.vroughness invert ior iso k lensradius "
    "levels mapname "
    "mapping maxdepth maxiter measuredfile metallic mfp nlevels normalmap octaves opacity "
    "outside p1 p2 pheomelanin phimax pixelbounds power r radius reflect reflectance rho "
    "rotate roughness scale scatterdistance screenwindow sensor shadowalpha sheen sheentint "
    "sigma sigma_a sigma_prime_s sigma_s spectrans speculartint splitdepth st tex tex1 tex2 "
    "thickness thin to transmit transmittance twosided udelta uroughness uscale uv v1 v2 "
    "value variation vdelta vroughness vscale warped whitebalance width width0 width1 wrap "
    "yon zmax zmin ";

/// names: with a blank around each.
bool is_among(std::string_view name, std::string_view names) {
    return names.find(fmt::format(" {} ", name)) != names.npos;
}

bool is_passed_over(std::string_view directive, std::string_view name) {
    return is_among(name, kPassedOver) || (directive == "films" && name == "filename");
}

/// Whether the parameter, or a later one that took its place, was asked for.
bool is_taken(const Parameters& parameters, const Parameter& parameter) {
    return std::ranges::any_of(parameters.all(), [&](const Parameter& other) {
        return other.asked && other.name == parameter.name;
    });
}

bool has_its_count(const Parameter& parameter) {
    const size_t values = parameter.numbers.size() + parameter.strings.size();
    return parameter.wants == 0 || values == parameter.wants;
}

} // namespace

void tell_left_over(const Parameters& parameters, std::string_view directive, std::string_view type,
                    Diagnostics& diagnostics) {
    for (const Parameter& p : parameters.all()) {
        if (!has_its_count(p)) {
            diagnostics.fail(p.place,
                             fmt::format("found {} of {}, expected {}",
                                         counted(p.numbers.size() + p.strings.size(), "value"),
                                         ovc::quoted(p.name), p.wants));
            return;
        }
        if (is_taken(parameters, p) || is_passed_over(directive, p.name))
            continue;
        const bool is_known = is_among(p.name, kOfPbrt);
        diagnostics.warn(is_known ? Gravity::Approximate : Gravity::Missing,
                         fmt::format("parameter {} of {} {}", p.name, directive, type), p.place,
                         fmt::format("the parameter {} of {} {} left out{}", ovc::quoted(p.name),
                                     directive, ovc::quoted(type),
                                     is_known ? "" : ": it is unknown"));
    }
}

} // namespace ovc::pbrt
