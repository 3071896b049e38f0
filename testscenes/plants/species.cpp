// SPDX-License-Identifier: Apache-2.0
// The table of species.
#include "testscenes/plants/species.h"

namespace ovc::plants {

namespace {

constexpr vec3 kBark(0.13f, 0.09f, 0.06f);
constexpr vec3 kStem(0.10f, 0.20f, 0.04f);
constexpr vec3 kOakLeaf[] = {
    {0.12f, 0.25f, 0.035f}, {0.15f, 0.29f, 0.05f}, {0.10f, 0.21f, 0.04f}, {0.20f, 0.30f, 0.05f}};
constexpr vec3 kMapleLeaf[] = {{0.62f, 0.22f, 0.03f}, {0.68f, 0.36f, 0.04f}, {0.50f, 0.12f, 0.03f}};
constexpr vec3 kBirchLeaf[] = {{0.30f, 0.40f, 0.07f}, {0.40f, 0.43f, 0.08f}, {0.24f, 0.36f, 0.06f}};
constexpr vec3 kWillowLeaf[] = {{0.24f, 0.34f, 0.09f}, {0.28f, 0.36f, 0.12f}};
constexpr vec3 kNeedle[] = {
    {0.045f, 0.12f, 0.05f}, {0.06f, 0.14f, 0.05f}, {0.05f, 0.13f, 0.07f}, {0.08f, 0.15f, 0.05f}};
constexpr vec3 kBushLeaf[] = {
    {0.11f, 0.24f, 0.05f}, {0.18f, 0.28f, 0.06f}, {0.34f, 0.30f, 0.06f}, {0.14f, 0.22f, 0.08f}};
constexpr vec3 kGrassBlade[] = {
    {0.18f, 0.32f, 0.05f}, {0.24f, 0.36f, 0.07f}, {0.36f, 0.36f, 0.10f}, {0.14f, 0.28f, 0.05f}};
constexpr vec3 kReedBlade[] = {{0.22f, 0.32f, 0.09f}, {0.34f, 0.36f, 0.13f}};
constexpr vec3 kPetal[] = {
    {0.75f, 0.06f, 0.04f}, {0.30f, 0.14f, 0.65f}, {0.85f, 0.60f, 0.04f}, {0.80f, 0.25f, 0.45f}};
constexpr vec3 kDaisyPetal[] = {{0.88f, 0.87f, 0.82f}};
constexpr vec3 kLilyPad[] = {{0.10f, 0.24f, 0.07f}, {0.15f, 0.28f, 0.08f}};
constexpr vec3 kStone[] = {{0.33f, 0.31f, 0.28f}, {0.26f, 0.25f, 0.24f}, {0.38f, 0.34f, 0.28f}};
constexpr vec3 kYellow(0.85f, 0.60f, 0.06f);

constexpr Species kSpecies[] = {
    {"oak", make_oak, 4, 36, kBark, kBark, kOakLeaf},
    {"maple", make_oak, 2, 36, kBark, kBark, kMapleLeaf},
    {"birch", make_birch, 4, 36, {0.66f, 0.63f, 0.57f}, kBark, kBirchLeaf},
    {"willow", make_willow, 2, 40, {0.17f, 0.13f, 0.09f}, kBark, kWillowLeaf},
    {"spruce", make_spruce, 5, 34, {0.12f, 0.075f, 0.05f}, kBark, kNeedle},
    {"bush", make_bush, 5, 16, kBark, kBark, kBushLeaf},
    {"grass", make_grass, 6, 9, kStem, kStem, kGrassBlade},
    {"reed", make_reed, 5, 16, kStem, {0.16f, 0.075f, 0.03f}, kReedBlade},
    {"flower", make_flower, 5, 9, kStem, kYellow, kPetal},
    {"daisy", make_daisy, 4, 9, kStem, kYellow, kDaisyPetal},
    {"lily", make_lily, 4, 14, kStem, {0.88f, 0.55f, 0.66f}, kLilyPad},
    {"rock", make_rock, 6, 14, kStem, kStem, kStone},
};

} // namespace

std::span<const Species> species() {
    return kSpecies;
}

} // namespace ovc::plants
