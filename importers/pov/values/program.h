// SPDX-License-Identifier: Apache-2.0
// FormulaProgram: a formula with the textures that it calls. A scene's functions are such programs.
#pragma once

#include "core/scene.h"

#include <memory>
#include <span>
#include <vector>

namespace ovc::pov {

struct FormulaProgram {
    Formula formula;                                 // calls textures[i] as texture i
    std::vector<ovc::Texture> textures;              // made of earlier ones
    std::vector<std::shared_ptr<const void>> owners; // of the pictures that the textures look at

    double operator()(std::span<const double> arguments) const {
        return evaluate(textures, formula, arguments);
    }
};
using ProgramPtr = std::shared_ptr<const FormulaProgram>;

/// Replaces the indices of the textures that a formula calls by those at their places.
void move_textures(Formula& formula, std::span<const uint32_t> places);

/// Returns the indices that copies of textures have in another list. add: appends a texture that
/// is made of earlier ones of that list, and returns its index.
template <class Add>
std::vector<uint32_t> copy_textures(std::span<const ovc::Texture> textures, const Add& add) {
    std::vector<uint32_t> places;
    for (ovc::Texture texture : textures) {
        for (TextureStop& stop : texture.stops)
            if (stop.texture != kNoTexture)
                stop.texture = places[stop.texture];
        move_textures(texture.pattern.formula, places);
        places.push_back(add(std::move(texture)));
    }
    return places;
}

/// Builds a formula step by step.
class ProgramBuilder {
public:
    void add(FormulaStep::Kind kind, uint32_t index = 0, uint32_t count = 0, double value = 0);
    void constant(double value) { add(FormulaStep::Kind::Constant, 0, 0, value); }
    /// Adds a call of another program with `count` arguments, which are on the stack.
    void call(const ProgramPtr& other, uint32_t count);
    /// Adds the value of the last texture of a program, or a component of its color, at the point
    /// that is on the stack.
    void texture(FormulaStep::Kind kind, const ProgramPtr& other, uint32_t component = 0);
    /// Returns the formula, or null where it cannot be evaluated because it takes too many steps.
    ProgramPtr take();

private:
    /// The place of another program's routines and textures in this one.
    struct Copied {
        ProgramPtr other; // stays alive, so that its address is its own
        uint32_t routine;
        std::vector<uint32_t> textures;
    };
    const Copied& copied(const ProgramPtr& other);

    std::vector<FormulaStep> own_; // of the last routine
    FormulaProgram program_;
    std::vector<Copied> copies_;
};

} // namespace ovc::pov
