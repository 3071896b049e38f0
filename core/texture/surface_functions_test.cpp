// SPDX-License-Identifier: Apache-2.0
#include "core/texture/surface_functions.h"

#include <gtest/gtest.h>

#include <vector>

namespace ovc {

namespace {

struct AskedSurface {
    uint32_t number;
    std::vector<double> parameters; // behind the point
    double value;
};

/// The values are those that povray 3.7.0.10 prints at (0.31, -0.42, 0.77).
const AskedSurface kAskedSurfaces[] = {
    {11, {1}, 0.47697769},                             // f_crossed_trough
    {12, {1}, 0.666121},                               // f_cubic_saddle
    {13, {1}, -0.20197453},                            // f_cushion
    {14, {2}, -0.90621608},                            // f_devils_curve
    {20, {1, 0.3, 0.4}, 0.7130536},                    // f_folium_surface
    {22, {1}, -0.763250937},                           // f_glob
    {23, {1}, 0.08497677},                             // f_heart
    {25, {2, 3, 0.1, 0.7, 1.5, 0.5, 70}, 0.201899071}, // f_helix1
    {25, {1, 0, 0.1, 0.7, 1, 1, 0}, 1.430060238},      // without turns
    {26, {1, 2, 0.1, 0.7, 1, 2, 0}, 1.711247469},      // f_helix2
    {31, {1, 0.6, 0.4}, -0.72988816},                  // f_hyperbolic_torus
    {33, {1, 0.2, 0.3}, -0.768814791},                 // f_kampyle_of_eudoxus
    {35, {0.1}, -0.6831836},                           // f_klein_bottle
    {36, {1}, -0.34796529},                            // f_kummer_surface_v1
    {37, {1, -0.5, -0.4, 0.3}, 1.14230054},            // f_kummer_surface_v2
    {38, {1}, -0.68243521},                            // f_lemniscate_of_gerono
    {41, {1}, -0.29196428},                            // f_mitre
    {42, {1}, -2.322845},                              // f_nodal_cubic
    {43, {1}, -0.20197453},                            // f_odd
    {44, {1, 0.3, 0.45, 3}, -0.52425916},              // f_ovals_of_cassini
    {45, {-1}, 1.109},                                 // f_paraboloid
    {46, {1, 0.3, 0.5}, -0.47400825},                  // f_parabolic_torus
    {48, {1}, -0.47351742},                            // f_pillow
    {49, {1}, 0.74874421},                             // f_piriform
    {51, {0.3, 0.2, 0.5, 0.7, 0.9}, 0.549716575},      // f_poly4
    {54, {1}, -0.78076562},                            // f_quartic_paraboloid
    {55, {1}, -0.0777048},                             // f_quartic_saddle
    {56, {1, 0.7, 2}, -0.9175396},                     // f_quartic_cylinder
    {65, {1}, -0.07826329},                            // f_steiners_roman
    {66, {1, 0.4, -0.1, 0.9}, 0.37068011},             // f_strophoid
    {71, {100, 0.7, 0.2}, -10},                        // f_torus2
    {72, {0.1}, -0.335303621},                         // f_torus_gumdrop
    {73, {1}, -0.345118},                              // f_umbrella
    {74, {1, 0.04}, 0.34618},                          // f_witch_of_agnesi
};

} // namespace

TEST(SurfaceFunction, HasTheValuesThatPovrayPrints) {
    for (const AskedSurface& asked : kAskedSurfaces) {
        const InternalFunction function = surface_function(asked.number);
        ASSERT_TRUE(function.call) << asked.number;
        std::vector<double> arguments{0.31, -0.42, 0.77};
        arguments.insert(arguments.end(), asked.parameters.begin(), asked.parameters.end());
        ASSERT_EQ(arguments.size(), size_t(function.count)) << asked.number;
        EXPECT_NEAR(function.call(arguments), asked.value, 1e-7) << asked.number;
    }
    EXPECT_FALSE(surface_function(1000).call);
}

} // namespace ovc
