// SPDX-License-Identifier: Apache-2.0
// PBRT's materials, spectra, lights, cameras and films become those of our scenes.
#include "importers/pbrt/look/spectrum.h"
#include "importers/test_files.h"

#include <numbers>

namespace ovc {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr const char* kMesh =
    " Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [0 0 0  1 0 0  0 1 0]\n";

Scene scene_of(const std::string& text) {
    const TestFolder folder;
    Result<Scene> scene = load(folder.write("a.pbrt", text));
    EXPECT_TRUE(scene) << (scene ? "" : scene.error().message);
    return scene ? std::move(*scene) : Scene{};
}

Material material_of(const std::string& text) {
    const Scene scene = scene_of(text + kMesh);
    return scene.meshes.empty() ? Material{} : scene.materials[scene.meshes[0].material];
}

void expect_color(const vec3& found, const vec3& expected, float tolerance, const char* what) {
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(found[i], expected[i], tolerance) << what << " " << i;
}

TEST(PbrtMapping, MatteNamesOfAllVersions) {
    const vec3 color(0.1f, 0.2f, 0.3f);
    for (const char* text :
         {"Material \"matte\" \"color Kd\" [.1 .2 .3]", "Material \"matte\" \"rgb Kd\" [.1 .2 .3]",
          "Material \"diffuse\" \"rgb reflectance\" [.1 .2 .3]",
          "MakeNamedMaterial \"m\" \"string type\" \"diffuse\" \"rgb reflectance\" [.1 .2 .3] "
          "NamedMaterial \"m\"",
          "Texture \"t\" \"spectrum\" \"constant\" \"rgb value\" [.2 .4 .6] Texture \"u\" "
          "\"spectrum\" "
          "\"scale\" \"texture tex\" \"t\" \"float scale\" .5 Material \"diffuse\" \"texture "
          "reflectance\" \"u\"",
          "Texture \"t\" \"color\" \"checkerboard\" \"color tex1\" [.2 .4 .6] \"color tex2\" [0 0 "
          "0] "
          "Material \"matte\" \"texture Kd\" \"t\"",
          "Material \"plastic\" \"color Kd\" [.1 .2 .3] \"color Ks\" [0 0 0]",
          "Material \"uber\" \"color Kd\" [.1 .2 .3]",
          "Material \"coateddiffuse\" \"rgb reflectance\" [.1 .2 .3] \"float roughness\" .4"}) {
        const Material m = material_of(text);
        expect_color(m.color, color, 1e-6f, text);
        ASSERT_TRUE(m.finish) << text;
        EXPECT_EQ(m.finish->diffuse, 1) << text;
        EXPECT_EQ(m.transmission, 0) << text;
        EXPECT_EQ(m.mirror, 0) << text;
    }
}

TEST(PbrtMapping, TranslucentSurfacesReflectTheirShare) {
    expect_color(material_of("Material \"translucent\"").color, vec3(0.125f), 1e-6f, "v3");
    expect_color(
        material_of("Material \"translucent\" \"rgb Kd\" [.4 .4 .8] \"rgb reflect\" [1 .5 .25]")
            .color,
        {0.4f, 0.2f, 0.2f}, 1e-6f, "reflect");
    expect_color(material_of("Material \"diffusetransmission\"").color, vec3(0.25f), 1e-6f, "v4");
    expect_color(material_of("Material \"diffusetransmission\" \"rgb reflectance\" [.4 .4 .8] "
                             "\"float scale\" .5")
                     .color,
                 {0.2f, 0.2f, 0.4f}, 1e-6f, "scale");
}

TEST(PbrtMapping, MirrorGlassMetalAndHoles) {
    const Material mirror = material_of("Material \"mirror\" \"color Kr\" [.7 .8 .9]");
    expect_color(mirror.finish->reflection, {0.7f, 0.8f, 0.9f}, 1e-6f, "mirror");
    EXPECT_GT(mirror.mirror, 0);
    for (const char* text :
         {"Material \"glass\" \"float index\" 1.3", "Material \"dielectric\" \"float eta\" 1.3",
          "Material \"glass\" \"float eta\" 1.3"}) {
        const Material glass = material_of(text);
        EXPECT_NEAR(glass.ior, 1.3, 1e-6) << text;
        EXPECT_EQ(glass.transmission, 1) << text;
        EXPECT_TRUE(glass.finish->fresnel) << text;
    }
    EXPECT_NEAR(material_of("Material \"dielectric\" \"spectrum eta\" \"glass-SF11\"").ior, 1.7847,
                1e-6);
    EXPECT_EQ(material_of("Material \"thindielectric\"").ior, 1);
    const Material gold = material_of("Material \"conductor\" \"spectrum eta\" \"metal-Au-eta\"");
    EXPECT_GT(gold.finish->reflection.x, 2 * gold.finish->reflection.z);
    const Material silver = material_of("Material \"conductor\" \"spectrum k\" \"spds/Ag.k.spd\"");
    EXPECT_NEAR(silver.finish->reflection.x, silver.finish->reflection.z, 0.1);
    const Material uber = material_of("Material \"uber\" \"color opacity\" [.25 .25 .25]");
    EXPECT_EQ(uber.transmission, 1);
    EXPECT_NEAR(uber.filter.x, 0.75f, 1e-6f);
    EXPECT_EQ(uber.ior, 1);
    EXPECT_TRUE(scene_of(std::string("Material \"interface\"") + kMesh).meshes.empty());
    const std::string lamp = "AreaLightSource \"diffuse\" Material \"interface\"";
    EXPECT_TRUE(scene_of("Film \"rgb\" WorldBegin " + lamp + kMesh).meshes.empty());
    EXPECT_EQ(scene_of("WorldBegin " + lamp + kMesh).meshes.size(), 1u) << "earlier versions";
}

TEST(PbrtMapping, SpectraBecomeTheirColors) {
    using pbrt::color_of_samples;
    const double flat[] = {400, 0.5, 700, 0.5};
    expect_color(color_of_samples(flat, false), vec3(0.5f), 1e-5f, "flat");
    const double flat_everywhere[] = {300, 0.5, 900, 0.5};
    expect_color(color_of_samples(flat_everywhere, true), vec3(0.5f), 1e-5f, "flat in v4");
    const double red[] = {300, 0, 599, 0, 601, 1, 800, 1};
    for (const bool is_v4 : {false, true}) {
        const vec3 r = color_of_samples(red, is_v4);
        EXPECT_GT(r.x, 4 * r.y) << is_v4;
        EXPECT_GT(r.x, 4 * r.z) << is_v4;
    }
    // The colors of sRGB's white and of a candle are from Charity, "What color is a blackbody?".
    expect_color(pbrt::black_body(6500), vec3(1.03f, 0.99f, 1.0f), 0.06f, "6500 K");
    const vec3 candle = pbrt::black_body(1900);
    EXPECT_GT(candle.x, 1.8f * candle.y);
    EXPECT_LT(candle.z, 0.1f);
    for (const double kelvin : {1000.0, 3000.0, 6000.0, 20000.0}) {
        const vec3 c = pbrt::black_body(kelvin);
        EXPECT_NEAR(0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z, 1, 0.12) << kelvin;
    }
    // v3 gives a scale of a spectrum that is 1 at its peak: of a candle hardly any light is seen.
    const float dim =
        scene_of("LightSource \"distant\" \"blackbody L\" [1900 1]").lights.at(0).color.y;
    EXPECT_NEAR(dim / candle.y, 0.0327f, 0.0005f);
    EXPECT_NEAR(scene_of("LightSource \"distant\" \"blackbody L\" 1900").lights.at(0).color.y,
                candle.y, 1e-6f);
    // These are gold's at 580 nm, from Johnson and Christy 1972.
    EXPECT_NEAR(pbrt::metal_color(vec3(0.27f), vec3(2.9f)).x, 0.89f, 0.01f);
}

/// Returns the light that arrives at a place whose normal faces it, in W/m2 or the like.
double irradiance(const Light& light, const dvec3& at) {
    const dvec3 there = light.parallel ? -light.direction : light.position - at;
    const double distance = glm::length(there);
    double share = 1;
    if (light.cone) {
        const double cosine = -glm::dot(there / distance, light.direction);
        share = cosine > light.cone->falloff_cosine ? std::pow(cosine, light.cone->tightness) : 0;
    }
    if (light.fade_distance > 0)
        share *= 2 / (1 + std::pow(distance / light.fade_distance, light.fade_power));
    return share * light.color.x;
}

TEST(PbrtMapping, DistantLightComesFromBeyondTheScene) {
    const Scene scene =
        scene_of(std::string("LightSource \"distant\" LightSource \"infinite\"") + kMesh);
    ASSERT_EQ(scene.lights.size(), 2u);
    for (const Light& light : scene.lights)
        EXPECT_TRUE(light.parallel && light.distant) << light.stand_in;
}

/// The camera sees nothing, so that the light gets no exposure.
TEST(PbrtMapping, LightsBringWhatPbrtsDo) {
    const struct {
        const char* text;
        dvec3 at;
        double expected;
    } cases[] = {
        {"LightSource \"point\" \"color I\" [8 8 8]", {0, 0, 2}, 2},
        {"Translate 0 0 2 LightSource \"point\" \"rgb I\" [8 8 8] \"point from\" [0 0 2]",
         {0, 0, 2},
         2},
        {"LightSource \"point\" \"rgb I\" [2 2 2] \"float scale\" 3", {1, 0, 0}, 6},
        {"LightSource \"distant\" \"color L\" [3 3 3] \"point from\" [0 0 9]", {1, 2, 3}, 3},
        {"LightSource \"spot\" \"color I\" [8 8 8] \"float coneangle\" 30", {0, 0, 2}, 2},
        {"LightSource \"spot\" \"color I\" [8 8 8] \"float coneangle\" 30", {0, 2, 2}, 0},
        // v4's powers and illuminances are those of light of color 1.
        {"LightSource \"point\" \"rgb I\" [3 1 1] \"float power\" 8", {0, 0, 2}, 3 / (2 * kPi)},
        {"LightSource \"point\" \"float scale\" 3 \"float power\" 8", {0, 0, 2}, 3 / (2 * kPi)},
        {"LightSource \"spot\" \"float power\" 2 \"float coneangle\" 60 \"float conedeltaangle\" "
         "60",
         {0, 0, 2},
         1 / kPi},
        {"LightSource \"distant\" \"rgb L\" [3 1 1] \"float illuminance\" 5", {0, 0, 2}, 15},
    };
    for (const auto& test : cases) {
        const Scene scene = scene_of(test.text);
        ASSERT_EQ(scene.lights.size(), 1u) << test.text;
        EXPECT_NEAR(irradiance(scene.lights[0], test.at), test.expected, 1e-4) << test.text;
    }
}

TEST(PbrtMapping, AreaLightsSendOutTheirLight) {
    const auto sum = [](const Scene& scene, const dvec3& at) {
        double total = 0;
        for (const Light& light : scene.lights)
            total += irradiance(light, at);
        return total;
    };
    // A disk of radius 1 sends L A / d^2 to a distance of 10, and nothing behind it.
    const std::string disk = "AreaLightSource \"diffuse\" \"rgb L\" [5 5 5] ";
    const Scene one = scene_of(disk + "Shape \"disk\"");
    EXPECT_NEAR(sum(one, {0, 0, 10}), 5 * kPi / 100, 0.005);
    EXPECT_EQ(sum(one, {0, 0, -10}), 0);
    EXPECT_NEAR(sum(scene_of("ReverseOrientation " + disk + "Shape \"disk\""), {0, 0, -10}),
                5 * kPi / 100, 0.005);
    EXPECT_NEAR(sum(scene_of("AreaLightSource \"diffuse\" \"rgb L\" [5 5 5] \"bool twosided\" true "
                             "Shape \"disk\""),
                    {0, 0, -10}),
                5 * kPi / 100, 0.005);
    // A sphere sends L pi r^2 / d^2 all ways; its surface is seen, and casts no shadow of its own.
    const Scene ball = scene_of(disk + "Shape \"sphere\"");
    for (const dvec3& at : {dvec3(10, 0, 0), dvec3(0, -10, 0), dvec3(0, 0, 10)})
        EXPECT_NEAR(sum(ball, at), 5 * kPi / 100, 0.005);
    EXPECT_EQ(ball.soup.chunks[0].mask(), kSeenByAll & ~kShadowsStandIns);
    EXPECT_EQ(ball.materials[ball.meshes[0].material].finish->ambient, vec3(5));
    // v4's power is that of each shape: the disk, and each of two triangles.
    const std::string lit = "AreaLightSource \"diffuse\" \"float power\" 5 ";
    const auto radiance = [](const Scene& scene) {
        return scene.materials[scene.meshes.at(0).material].optics->emission.x;
    };
    EXPECT_NEAR(radiance(scene_of(lit + "Scale 2 2 2 Shape \"disk\"")), 5 / (4 * kPi * kPi), 0.002);
    EXPECT_NEAR(radiance(scene_of(lit + "Shape \"trianglemesh\" \"integer indices\" [0 1 2 1 3 2] "
                                        "\"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0]")),
                5 / (0.5 * kPi), 1e-5);
    // Many spheres become few lights with all of their light.
    std::string many;
    for (int i = 0; i < 100; ++i)
        many += disk + "Translate 0.001 0 0 Shape \"sphere\" \"float radius\" 0.1\n";
    const Scene lamps = scene_of(many);
    EXPECT_EQ(lamps.lights.size(), 32u);
    EXPECT_NEAR(sum(lamps, {0, 0, 10}), 100 * 5 * kPi * 0.01 / 100, 0.005);
}

TEST(PbrtMapping, PathTracingKnowsSurfacesAsTheFileHasThem) {
    using Boundary = Optics::Boundary;
    const auto optics_of = [](const char* text) { return *material_of(text).optics; };
    const Optics matte = optics_of("Material \"matte\" \"rgb Kd\" [.1 .2 .3]");
    EXPECT_EQ(matte.boundary, Boundary::None);
    expect_color(matte.diffuse, {0.1f, 0.2f, 0.3f}, 1e-6f, "matte");
    const Optics plastic = optics_of("Material \"plastic\" \"rgb Kd\" [.4 .4 .4] \"rgb Ks\" "
                                     "[.5 .5 .5] \"float roughness\" .09");
    EXPECT_EQ(plastic.boundary, Boundary::Dielectric);
    expect_color(plastic.reflection, vec3(0.5f), 1e-6f, "plastic's coat");
    EXPECT_NEAR(plastic.width, 0.4349f, 1e-4f) << "as v3 maps a roughness of 0.09";
    EXPECT_EQ(optics_of("Material \"metal\" \"float roughness\" 1").width, 1);
    EXPECT_NEAR(optics_of("Material \"disney\" \"float roughness\" 0.5").width, 0.25f, 1e-6f);
    const Optics coated = optics_of("Material \"coateddiffuse\" \"rgb reflectance\" [.5 1 0] "
                                    "\"bool remaproughness\" false \"float roughness\" 0.05");
    EXPECT_NEAR(coated.width, 0.05f, 1e-6f);
    EXPECT_TRUE(coated.internal_reflection);
    expect_color(coated.diffuse, {0.5f, 1, 0}, 1e-6f, "coated");
    const Optics mirror = optics_of("Material \"mirror\" \"rgb Kr\" [.7 .8 .9]");
    EXPECT_EQ(mirror.boundary, Boundary::Mirror);
    expect_color(mirror.reflection, {0.7f, 0.8f, 0.9f}, 1e-6f, "mirror");
    const Optics glass = optics_of("Material \"dielectric\" \"float eta\" 1.3");
    EXPECT_EQ(glass.boundary, Boundary::Dielectric);
    EXPECT_NEAR(glass.ior, 1.3, 1e-6);
    EXPECT_EQ(glass.through, vec3(1));
    EXPECT_EQ(optics_of("Material \"thindielectric\"").boundary, Boundary::Thin);
    const Optics gold = optics_of("Material \"conductor\" \"spectrum eta\" \"metal-Au-eta\" "
                                  "\"float roughness\" 0.04");
    EXPECT_EQ(gold.boundary, Boundary::Metal);
    EXPECT_GT(gold.reflection.x, 2 * gold.reflection.z);
    EXPECT_NEAR(gold.width, 0.2f, 1e-6f);
    const Optics coat = optics_of("Material \"coatedconductor\" \"float roughness\" 1 \"float "
                                  "conductor.uroughness\" 0.01 \"float conductor.vroughness\" 0.07 "
                                  "\"spectrum conductor.k\" \"metal-Au-k\"");
    EXPECT_NEAR(coat.width, 0.2f, 1e-6f) << "the mean of both, of the metal's own names";
    expect_color(coat.reflection, {0.988f, 0.724f, 0.252f}, 1e-6f, "gold below a coat");
    const Optics veil = optics_of("Material \"uber\" \"color opacity\" [.25 .25 .25]");
    EXPECT_EQ(veil.boundary, Boundary::None);
    expect_color(veil.through, vec3(0.75f), 1e-6f, "holes");
    expect_color(veil.diffuse, vec3(0.25f * 0.25f), 1e-6f, "what is left");
}

TEST(PbrtMapping, PathTracingKnowsEmittersAndNoneOfTheirStandIns) {
    const Scene scene =
        scene_of(std::string("LightSource \"point\" LightSource \"infinite\" Material \"matte\" "
                             "\"rgb Kd\" [.1 .2 .3] AreaLightSource \"diffuse\" \"rgb L\" [5 6 7] "
                             "\"bool twosided\" true") +
                 kMesh);
    const Optics& lamp = *scene.materials[scene.meshes[0].material].optics;
    EXPECT_EQ(lamp.emission, vec3(5, 6, 7));
    EXPECT_TRUE(lamp.two_sided);
    expect_color(lamp.diffuse, {0.1f, 0.2f, 0.3f}, 1e-6f, "what it reflects");
    int kept = 0;
    for (const Light& light : scene.lights)
        kept += !light.stand_in;
    EXPECT_EQ(kept, 1) << "the point";
    EXPECT_GT(scene.lights.size(), 2u);
}

TEST(PbrtMapping, TheSkyIsABackground) {
    const Scene scene = scene_of("LightSource \"infinite\" \"rgb L\" [.1 .2 .3] \"float scale\" 2");
    expect_color(scene.background.horizon, {0.2f, 0.4f, 0.6f}, 1e-6f, "sky");
    EXPECT_EQ(scene_of("LightSource \"point\"").background.zenith, vec3(0)) << "no sky is black";
    EXPECT_EQ(scene_of(kMesh).background.horizon, Background{}.horizon) << "no light at all: ours";
}

TEST(PbrtMapping, ALightWithoutADirectionIsSaid) {
    const TestFolder folder;
    for (const char* light : {"spot", "distant"}) {
        std::vector<std::string> warnings;
        const std::string text = std::string("LightSource \"") + light +
                                 "\" \"point from\" [1 2 3] \"point to\" [1 2 3]" + kMesh;
        ASSERT_TRUE(load(folder.write("a.pbrt", text), gather(warnings)));
        ASSERT_EQ(warnings.size(), 1u) << light;
        EXPECT_EQ(folder.plain(warnings[0]),
                  "a.pbrt:1: a light left out: its \"from\" and \"to\" make no direction");
    }
}

/// BT.2020's red has more red than sRGB's, and less than none of the others.
TEST(PbrtMapping, ColorsAreOfTheColorSpaceThatIsNamed) {
    const Scene scene =
        scene_of("WorldBegin\nAttributeBegin ColorSpace \"rec2020\"\n"
                 "Material \"diffuse\" \"rgb reflectance\" [.5 0 0]" +
                 std::string(kMesh) + "Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5]" +
                 kMesh + "AttributeEnd\nMaterial \"diffuse\" \"rgb reflectance\" [.5 0 0]" + kMesh);
    ASSERT_EQ(scene.meshes.size(), 3u);
    const auto color = [&](size_t mesh) {
        return scene.materials[scene.meshes[mesh].material].color;
    };
    expect_color(color(0), {0.8302455f, 0, 0}, 1e-5f, "red");
    expect_color(color(1), vec3(0.5f), 1e-5f, "grey");
    expect_color(color(2), {0.5f, 0, 0}, 1e-6f, "sRGB again");
}

TEST(PbrtMapping, MaterialsAreMixedColorByColor) {
    const Material mixed = material_of(
        "MakeNamedMaterial \"a\" \"string type\" \"matte\" \"rgb Kd\" [1 0 1] "
        "MakeNamedMaterial \"b\" \"string type\" \"matte\" \"rgb Kd\" [0 1 0] "
        "Material \"mix\" \"string namedmaterial1\" \"a\" \"string namedmaterial2\" \"b\" "
        "\"rgb amount\" [.25 .5 1]");
    expect_color(mixed.color, {0.25f, 0.5f, 1}, 1e-6f, "mixed");
}

/// Of two that are no one surface, hits meet the one or the other.
TEST(PbrtMapping, AMixOfTwoThatShineIsMadeOfBoth) {
    const Scene scene = scene_of(
        std::string("MakeNamedMaterial \"r\" \"string type\" \"mirror\" MakeNamedMaterial \"g\" "
                    "\"string type\" \"glass\" Material \"mix\" \"string materials\" "
                    "[\"r\" \"g\"] \"float amount\" 0.25") +
        kMesh);
    const Material& mixed = scene.materials[scene.meshes.at(0).material];
    ASSERT_TRUE(mixed.mix);
    const std::vector<TextureStop>& stops = scene.textures[mixed.mix->texture].stops;
    ASSERT_EQ(stops.size(), 2u);
    EXPECT_EQ(scene.materials[stops[0].texture].name, "r");
    EXPECT_EQ(stops[0].at, 0.75);
    EXPECT_EQ(scene.materials[stops[1].texture].name, "g");
    EXPECT_EQ(stops[1].at, 0.25);
}

TEST(PbrtMapping, LightGoesThroughLeavesAndFrostedGlass) {
    const Material leaf = material_of("Material \"diffusetransmission\" \"rgb transmittance\" "
                                      "[.4 .2 .1] \"float scale\" .5");
    expect_color(leaf.optics->diffuse_behind, {0.2f, 0.1f, 0.05f}, 1e-6f, "v4");
    EXPECT_GT(leaf.finish->diffuse_back, 0);
    const Material cloth = material_of("Material \"translucent\" \"rgb Kd\" [.4 .4 .8] \"rgb "
                                       "transmit\" [1 .5 .25]");
    expect_color(cloth.optics->diffuse_behind, {0.4f, 0.2f, 0.2f}, 1e-6f, "v3");
    const auto width = [](const char* text) { return material_of(text).optics->width; };
    EXPECT_NEAR(width("Material \"dielectric\" \"float roughness\" .04"), 0.2f, 1e-6f);
    EXPECT_EQ(width("Material \"dielectric\""), 0);
    EXPECT_EQ(width("Material \"glass\""), 0);
    EXPECT_NEAR(width("Material \"glass\" \"float uroughness\" .09 \"float vroughness\" .09"),
                0.4349f, 1e-4f);
    EXPECT_EQ(width("Material \"uber\" \"rgb Kt\" [.5 .5 .5]"), 0) << "its glass is clear";
}

TEST(PbrtMapping, GlassIsFilledWithWhatAbsorbs) {
    const std::string medium = "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb "
                               "sigma_a\" [4 1 0] \"float scale\" .5 \"rgb sigma_s\" ";
    const std::string in_glass = " MediumInterface \"m\" \"\" Material \"dielectric\"";
    const Material tinted = material_of(medium + "[0 0 0]" + in_glass);
    ASSERT_TRUE(tinted.absorption);
    expect_color((vec3(1) - tinted.absorption->color) / tinted.absorption->distance, {2, 0.5f, 0},
                 1e-6f, "absorbed per length");
    EXPECT_GE(tinted.absorption->power, 1000);
    EXPECT_FALSE(material_of(medium + "[1 0 0]" + in_glass).absorption) << "it scatters";
    EXPECT_FALSE(material_of(medium + "[0 0 0] MediumInterface \"m\" \"\"").absorption);
}

TEST(PbrtMapping, SpectraMayStandInFiles) {
    const TestFolder folder;
    folder.write("half.spd", "# nm and value\n300 .5\n900 .5\n");
    folder.write("no.spd", "300 .5\n900 half\n");
    const auto color_of = [&](const std::string& file) {
        const Result<Scene> scene = load(
            folder.write("a.pbrt", "Material \"matte\" \"spectrum Kd\" \"" + file + "\"" + kMesh));
        return scene ? scene->materials[scene->meshes.at(0).material].color : vec3(-1);
    };
    expect_color(color_of("half.spd"), vec3(0.5f), 1e-4f, "in a file");
    folder.write("quarter.spd", "300 .25\n900 .25\n");
    expect_color(color_of("quarter.spd"), vec3(0.25f), 1e-4f, "in another");
    expect_color(color_of("no.spd"), vec3(0.5f), 1e-6f, "the default");
}

/// Half of white paint and half of a mirror reflect all light, whichever of them is first.
TEST(PbrtMapping, AMixKeepsTheLightOfBothMaterials) {
    using Boundary = Optics::Boundary;
    const std::string both = "MakeNamedMaterial \"m\" \"string type\" \"matte\" \"rgb Kd\" "
                             "[1 1 1] MakeNamedMaterial \"r\" \"string type\" \"mirror\" \"rgb "
                             "Kr\" [1 1 1] MakeNamedMaterial \"g\" \"string type\" \"glass\" ";
    const auto mix = [&](const char* names, const char* amount) {
        return material_of(both + "Material \"mix\" \"string materials\" " + names +
                           " \"float amount\" " + amount);
    };
    for (const auto& [names, amount] :
         {std::pair("[\"m\" \"r\"]", "0.5"), std::pair("[\"r\" \"m\"]", "0.5"),
          std::pair("[\"m\" \"r\"]", "0.2"), std::pair("[\"r\" \"m\"]", "0.8")}) {
        const Material m = mix(names, amount);
        ASSERT_EQ(m.optics->boundary, Boundary::Mirror) << names << amount;
        const float share = m.optics->reflection.x;
        EXPECT_NEAR(share, amount[2] == '5' ? 0.5 : 0.2, 1e-6) << names << amount;
        // The ground lies below the mirror.
        EXPECT_NEAR(share + (1 - share) * m.optics->diffuse.x, 1, 1e-6) << names << amount;
        ASSERT_TRUE(m.finish && m.mirror == 1);
        EXPECT_NEAR(m.color.x * m.finish->diffuse + m.finish->reflection.x, 1, 1e-6);
    }
    const Material clear = mix("[\"m\" \"g\"]", "0.25");
    EXPECT_EQ(clear.optics->boundary, Boundary::Dielectric);
    EXPECT_NEAR(clear.optics->through.x, 0.25, 1e-6);
    EXPECT_NEAR(clear.optics->diffuse.x, 0.75, 1e-6);
    EXPECT_EQ(mix("[\"r\" \"g\"]", "0.25").optics->boundary, Boundary::Mirror);
    const Material veil =
        material_of(both + "MakeNamedMaterial \"n\" \"string type\" \"interface\" "
                           "Material \"mix\" \"string materials\" [\"m\" \"n\"] "
                           "\"float amount\" 0.75");
    EXPECT_EQ(veil.optics->through, vec3(0.75f));
    EXPECT_EQ(veil.optics->diffuse, vec3(0.25f));
    EXPECT_EQ(veil.transmission, 0.75f);
    EXPECT_EQ(veil.color * veil.finish->diffuse, vec3(0.25f));
}

/// In v4 lights whose spectra are pairs have the luminance of white, times their scale, and the
/// color of their spectrum, which is 0 beyond its ends. That of the same light at all wavelengths
/// is (1.205, 0.948, 0.909) in sRGB.
TEST(PbrtMapping, SpectraOfLightsTellNoStrengthInV4) {
    const auto light_of = [](const std::string& film) {
        const Scene scene = scene_of("Film \"" + film +
                                     "\" LightSource \"distant\" \"spectrum L\" [300 7 900 7] "
                                     "\"float scale\" 3");
        return scene.lights.at(0).color / scene.exposure;
    };
    expect_color(light_of("image"), vec3(21), 1e-3f, "v3");
    expect_color(light_of("rgb"), 3.0f * vec3(1.205f, 0.948f, 0.909f), 0.03f, "v4");
}

/// The colors are those of pictures of pbrt-v4: of a white floor in such light, and of a sphere of
/// such a material in white light.
TEST(PbrtMapping, SpectraOfV4HaveTheColorsOfItsPictures) {
    const auto light_of = [](const std::string& spectrum) {
        const Scene scene =
            scene_of("Film \"rgb\" LightSource \"distant\" \"spectrum L\" " + spectrum);
        return scene.lights.at(0).color / scene.exposure;
    };
    expect_color(light_of("\"stdillum-D65\""), vec3(1), 2e-3f, "D65");
    expect_color(light_of("\"stdillum-A\""), {1.846f, 0.827f, 0.233f}, 0.01f, "A");
    expect_color(light_of("[400 1 500 3 600 8 700 7]"), {1.775f, 0.848f, 0.238f}, 0.03f, "pairs");
    const auto color_of = [](const std::string& film) {
        return material_of("Film \"" + film +
                           "\" Material \"diffuse\" \"spectrum reflectance\" "
                           "[400 1 500 1]")
            .color;
    };
    EXPECT_GT(color_of("image").x, 0.99f) << "v3's go on beyond their ends";
    EXPECT_LT(color_of("rgb").x, 0.05f);
}

/// A shutter that is open for a quarter of v4's time lets in a quarter of the light.
TEST(PbrtMapping, TheShutterExposesTheFilmOfV4) {
    const auto light_of = [](const std::string& film) {
        const Scene scene =
            scene_of("Film \"" + film +
                     "\" \"float iso\" 200 Camera \"perspective\" \"float "
                     "shutteropen\" 0.5 \"float shutterclose\" 0.75 LightSource \"distant\"");
        return scene.lights.at(0).color / scene.exposure;
    };
    expect_color(light_of("rgb"), vec3(0.5f), 1e-6f, "v4");
    expect_color(light_of("image"), vec3(2), 1e-6f, "v3");
}

TEST(PbrtMapping, CamerasSeeWhatPbrtsSee) {
    // pbrt is left-handed: looking along +z with +y up, +x is on the right.
    const Scene scene =
        scene_of("Film \"image\" \"integer xresolution\" 200 \"integer yresolution\" 100 "
                 "LookAt 1 2 3  1 2 9  0 1 0 Camera \"perspective\" \"float fov\" 90");
    ASSERT_TRUE(scene.camera && scene.camera->window);
    ASSERT_TRUE(scene.size);
    EXPECT_EQ(scene.size->width, 200u);
    EXPECT_EQ(scene.size->height, 100u);
    const ImageWindow& w = *scene.camera->window;
    EXPECT_LT(glm::length(scene.camera->eye - dvec3(1, 2, 3)), 1e-12);
    EXPECT_LT(glm::length(w.direction - dvec3(0, 0, 1)), 1e-12);
    EXPECT_LT(glm::length(w.right - dvec3(4, 0, 0)), 1e-12) << "90 degrees along the shorter side";
    EXPECT_LT(glm::length(w.up - dvec3(0, 2, 0)), 1e-12);

    const Scene mirrored = scene_of("Scale -1 1 1 LookAt 0 0 0 0 0 1 0 1 0 Camera \"perspective\"");
    EXPECT_LT(mirrored.camera->window->right.x, 0);
    const Scene flat =
        scene_of("Translate 0 0 5 Camera \"orthographic\" \"float screenwindow\" [0 4 0 2]");
    EXPECT_TRUE(flat.camera->window->orthographic);
    EXPECT_LT(glm::length(flat.camera->eye - dvec3(2, 1, -5)), 1e-12);
    EXPECT_LT(glm::length(flat.camera->window->right - dvec3(4, 0, 0)), 1e-12);
    const Scene lens =
        scene_of("Scale 0.5 0.5 0.5 Camera \"perspective\" \"float lensradius\" 0.25 "
                 "\"float focaldistance\" 3");
    ASSERT_TRUE(lens.camera->lens); // a unit of the camera is two of the world
    EXPECT_LT(glm::length(lens.camera->lens->right - dvec3(0.5, 0, 0)), 1e-12);
    EXPECT_LT(glm::length(lens.camera->lens->up - dvec3(0, 0.5, 0)), 1e-12);
    EXPECT_EQ(lens.camera->lens->focus, 3) << "t, of a direction 2 long";
    EXPECT_FALSE(scene.camera->lens);
    EXPECT_TRUE(scene_of("Camera \"environment\"").camera);
    EXPECT_FALSE(scene_of("Scale 0 1 1 Camera \"perspective\"").camera);
    EXPECT_FALSE(scene_of(kMesh).camera);
}

TEST(PbrtMapping, LightIsFittedToThePicture) {
    const std::string view = "Camera \"perspective\" WorldBegin Translate 0 0 2 ";
    const std::string wall =
        "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [-1 -1 0 1 "
        "-1 0 0 1 0] ";
    const auto brightness = [&](const std::string& intensity) {
        const Scene scene =
            scene_of(view + "LightSource \"point\" \"point from\" [0 0 -1] \"color I\" [" +
                     intensity + "] " + wall);
        return irradiance(scene.lights[0], {0, 0, 2});
    };
    EXPECT_NEAR(brightness("1 1 1"), 1, 1e-3) << "let be";
    const double dimmed = brightness("1000 1000 1000"), raised = brightness("1e-3 1e-3 1e-3");
    EXPECT_LT(dimmed, 20);
    EXPECT_GT(raised, 0.5);
    EXPECT_NEAR(dimmed, raised, 0.01 * raised);
    const Scene bright = scene_of(view +
                                  "LightSource \"point\" \"point from\" [0 0 -1] \"color I\" "
                                  "[1000 1000 1000] " +
                                  wall);
    EXPECT_NEAR(irradiance(bright.lights[0], {0, 0, 2}) / double(bright.exposure), 1000, 1)
        << "what it was multiplied by is known";
}

} // namespace
} // namespace ovc
