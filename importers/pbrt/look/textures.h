// SPDX-License-Identifier: Apache-2.0
// Textures keeps pbrt's textures by their names, and makes those of the scene that materials use:
// pictures, products, mixes, blocks and noise. Others are replaced by their mean.
#pragma once

#include "importers/pbrt/interpret/scoped_names.h"
#include "importers/pbrt/interpret/tokens.h"
#include "importers/pbrt/interpret/transform.h"
#include "importers/pbrt/look/spectrum.h"

#include <array>
#include <map>
#include <optional>
#include <unordered_map>

namespace ovc::pbrt {

/// The max number of textures, or of mixes of materials, that are evaluated for one: they stand in
/// each other, and those that name another twice double their cost each time.
inline constexpr uint32_t kMaxCombined = 1000;

/// The contents of a Texture directive.
struct TextureRequest {
    std::string type; // its class, "scale"
    Parameters parameters;
    Place place;
    dmat4 to_world{1}; // of its own space
    bool is_float = false;
};

class Textures {
public:
    Textures(Diagnostics& diagnostics, const Tokens& tokens)
        : diagnostics_(diagnostics), tokens_(tokens) {}

    /// What follows is read as v4 does; lights too, whose spectra then tell no strength: each
    /// counts as if its luminance were 1.
    void read_as_v4() { is_v4_ = true; }
    bool is_v4() const { return is_v4_; }

    /// Adds a texture. Warns of a pattern that is shown by its mean wherever it is used, but not of
    /// floats, which Alphas may evaluate.
    void define(const std::string& name, TextureRequest request);
    /// Warns of the textures of a directive that are asked for, but not evaluated at hits.
    void tell_means(const Parameters& parameters) const;
    /// Warns that textures of this class are shown by their mean, unless they are plain ones, whose
    /// parts are told of.
    void tell_mean(const std::string& type, const Place& place) const;

    /// Returns the color that a parameter states, or the mean of the texture that it names;
    /// `otherwise` without either.
    vec3 color(const Parameters& parameters, std::string_view name, const vec3& otherwise) const;
    double number(const Parameters& parameters, std::string_view name, double otherwise) const;
    /// Returns whether the parameter names a texture that is not the same all over. Masks made of
    /// such patterns are better not used.
    bool is_pattern(const Parameters& parameters, std::string_view name) const;

    /// Returns the texture of the scene that the parameter names; nothing if it names none, or one
    /// that is shown by its mean.
    std::optional<uint32_t> texture(const Parameters& parameters, std::string_view name);
    /// Returns the product of a texture of the scene and a color.
    uint32_t product(uint32_t texture, const vec3& color);
    /// Returns a texture of two, of which the second has a share.
    uint32_t mix(const TextureStop& low, const TextureStop& high, const TextureStop& share);
    /// Returns a texture of stops that count in proportion to their `at`.
    uint32_t average(std::vector<TextureStop> stops);
    const std::vector<TextureStop>& stops_of(uint32_t texture) const {
        return scene_.textures[texture].stops;
    }
    /// Adds a picture as a texture of the scene. place: names it.
    uint32_t image(const std::string& file, const Place& place, ImageTexture image, bool on_uv);
    std::array<size_t, 2> begin_scope() const { return {by_name_[0].begin(), by_name_[1].begin()}; }
    /// Ends the scope for which begin_scope() returned `begin`.
    void end_scope(const std::array<size_t, 2>& begin);
    /// Returns whether texture() has returned the texture of floats that has this name now.
    bool is_used(const std::string& name) const;
    /// Returns whether a texture of the scene lies on texture coordinates.
    bool is_on_uv(uint32_t texture) const;

    /// Moves the textures and their pictures to the scene.
    void take(Scene& scene);

private:
    struct Definition {
        TextureRequest request;
        vec3 mean{0};
        bool is_pattern = false;
        std::map<std::string, size_t, std::less<>> parts; // parameters that name textures
        uint32_t count = 1; // of textures that are evaluated for it, each as often as it is named
        bool is_made = false;
        std::optional<uint32_t> made; // nothing: it is shown by its mean
    };

    void say_mean(const std::string& type, const Place& place) const;
    const Definition* find(const Parameters& parameters, std::string_view name) const;
    const Definition* find(const Parameter& parameter, bool of_floats) const;
    vec3 mean(const std::string& type, const Parameters& parameters) const;
    std::optional<uint32_t> make(size_t definition);
    void check_word(const Parameters& parameters, std::string_view name,
                    std::initializer_list<std::string_view> known) const;
    std::optional<uint32_t> make_image(const TextureRequest& request);
    std::optional<uint32_t> make_checkerboard(const Definition& definition);
    std::optional<uint32_t> make_combined(const Definition& definition, TextureKind kind,
                                          std::initializer_list<std::string_view> names);
    /// Adds a texture of one of two parameters: the second where the pattern is 1.
    std::optional<uint32_t> make_choice(const Definition& definition, Texture texture,
                                        const std::array<std::string_view, 2>& names);
    std::optional<uint32_t> make_dots(const Definition& definition);
    std::optional<uint32_t> make_bilerp(const Definition& definition);
    uint32_t make_noise(const TextureRequest& request);
    std::optional<TextureStop> stop(const Definition& definition, std::string_view name,
                                    const vec3& otherwise);

    Diagnostics& diagnostics_;
    const Tokens& tokens_;
    bool is_v4_ = false;
    std::vector<Definition> definitions_;        // those of a name that was defined anew stay
    std::array<ScopedNames<size_t>, 2> by_name_; // those of colors, then those of floats
    Scene scene_;                                // only its textures and pictures
};

} // namespace ovc::pbrt
