// SPDX-License-Identifier: Apache-2.0
// GraphicsState is the state that directives change, and StateStack saves and restores it.
#pragma once

#include "importers/pbrt/interpret/transform.h"
#include "importers/pbrt/look/lights.h"

#include <array>
#include <memory>
#include <vector>

namespace ovc::pbrt {

/// The transforms at the start and at the end of the motion.
struct Transforms {
    std::array<dmat4, 2> at{dmat4(1), dmat4(1)};
    std::array<bool, 2> active{true, true};

    /// A shape that is nowhere does not move; NaN is no number's equal.
    bool move() const { return at[0] != at[1] && is_finite(at[0]) && is_finite(at[1]); }
    void multiply(const dmat4& by) {
        for (size_t i = 0; i < 2; ++i)
            if (active[i])
                at[i] = at[i] * by;
    }
    void set(const dmat4& to) {
        for (size_t i = 0; i < 2; ++i)
            if (active[i])
                at[i] = to;
    }
};

/// A parameter of the directives of one kind that follow, unless they state it themselves.
struct Default {
    std::string of; // "shape", "light", "material", "medium" or "texture"
    Parameter parameter;
};

struct GraphicsState {
    Transforms transforms;
    uint32_t material = 0;
    std::optional<Emission> emission;
    bool reversed = false;
    std::optional<vec3> absorbed_inside; // per length in the medium inside, which only absorbs
    dmat3 to_srgb{1};                    // from the color space of "rgb"
    std::shared_ptr<const std::vector<Default>> defaults; // by Attribute, or null
    /// The meaning that names of textures and materials had where the scope began.
    struct Names {
        std::array<size_t, 2> textures{};
        size_t alphas = 0, materials = 0;
    } names;
};

/// The kind of directive that opened a level; the same kind closes it.
enum class Scope { Attribute, Transform, Object, Import };

class StateStack {
public:
    GraphicsState now;

    void push(Scope scope) { saved_.push_back({scope, now}); }
    /// Returns to the state where the last level of `scope` was opened. Levels opened since are
    /// closed, too; but attributes and transforms never close an object or an import. Returns false
    /// if no such level is open.
    bool pop(Scope scope) {
        size_t i = saved_.size();
        while (i > 0 && saved_[i - 1].scope != scope) {
            const bool is_wall =
                saved_[i - 1].scope == Scope::Object || saved_[i - 1].scope == Scope::Import;
            if (is_wall && scope != Scope::Object && scope != Scope::Import)
                return false;
            --i;
        }
        if (i == 0)
            return false;
        if (scope == Scope::Transform)
            now.transforms = saved_[i - 1].state.transforms;
        else
            now = saved_[i - 1].state;
        saved_.resize(i - 1, {scope, {}});
        return true;
    }
    size_t depth() const { return saved_.size(); }
    void clear() { saved_.clear(); }

private:
    struct Saved {
        Scope scope;
        GraphicsState state;
    };
    std::vector<Saved> saved_;
};

} // namespace ovc::pbrt
