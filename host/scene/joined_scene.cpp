// SPDX-License-Identifier: Apache-2.0
// Appends scene after scene. Indices of materials, meshes and cutouts move by the number that was
// there.
#include "host/scene/joined_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <utility>

namespace ovc {

namespace {

template <class T>
void append(std::vector<T>& to, std::vector<T>& from) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

class Joining {
public:
    Joining(NamedScene first, const LogSink& log)
        : log_(log), all_(std::move(first.scene)), triangles_(all_.soup.triangle_count()) {
        all_.saved = {};
    }

    void add(NamedScene next) {
        Scene& scene = next.scene;
        add_instancing(scene);
        move_bumps(scene, uint32_t(all_.textures.size()), uint32_t(all_.bumps.size()));
        if (!all_.camera)
            all_.faces = std::move(scene.faces);
        take_first(all_.camera, scene.camera, next.name, "camera");
        all_.moves = all_.moves || scene.moves;
        if (!all_.size)
            all_.part = scene.part;
        take_first(all_.size, scene.size, next.name, "picture's size");
        take_first(all_.max_depth, scene.max_depth, next.name, "depth");
        take_first(all_.samples, scene.samples, next.name, "rays a pixel");
        take_gamma(scene, next.name);
        const auto materials = uint32_t(all_.materials.size());
        const auto meshes = uint32_t(all_.meshes.size());
        const auto cutouts = uint32_t(all_.cutouts.size());
        const auto textures = uint32_t(all_.textures.size());
        const auto move = [](uint32_t& index, uint32_t by) { index += index == kNone ? 0 : by; };
        for (MeshInfo& mesh : scene.meshes) {
            mesh.material += materials;
            move(mesh.normals_from, meshes);
            move(mesh.uv_from, meshes);
            move(mesh.cutout, cutouts);
            move(mesh.shadow_cutout, cutouts);
        }
        move_light_groups(scene);
        for (Cutout& cutout : scene.cutouts)
            move(cutout.texture, textures);
        for (Texture& texture : scene.textures)
            if (texture.image)
                texture.image->picture += uint32_t(all_.pictures.size());
        move_textures(scene, textures, materials);
        append(all_.pictures, scene.pictures);
        append(all_.bumps, scene.bumps);
        append(all_.textures, scene.textures);
        append(all_.materials, scene.materials);
        append(all_.cutouts, scene.cutouts);
        append(all_.meshes, scene.meshes);
        append(all_.soup.chunks, scene.soup.chunks);
        append(all_.lights, scene.lights);
        append(all_.files, scene.files);
        append(all_.omissions, scene.omissions);
        take_background(scene, next.name);
        all_.name += " + " + scene.name;
    }

    Scene take() { return std::move(all_); }

private:
    void warn(const std::string& name, std::string_view what) const {
        say(log_, LogLevel::Warning,
            fmt::format("{}: its {} left out: a scene of several files has one", name, what));
    }

    /// Gives the scene's groups of lights other numbers than those of the scenes before have.
    void move_light_groups(Scene& scene) {
        uint32_t next = light_groups_;
        const auto move = [&](uint32_t& group) {
            if (group == kNone)
                return;
            group += light_groups_;
            next = std::max(next, group + 1);
        };
        for (Light& light : scene.lights)
            move(light.group);
        for (MeshInfo& mesh : scene.meshes)
            move(mesh.lit_by.group);
        light_groups_ = next;
    }

    /// Moves the indices of the scene's textures and materials, in it and of them.
    static void move_textures(Scene& scene, uint32_t textures, uint32_t materials) {
        std::vector<bool> mixes(scene.textures.size());
        for (Material& material : scene.materials) {
            for (uint32_t* other : {&material.under, &material.inside})
                *other += *other == kNone ? 0 : materials;
            if (material.mix)
                mixes[material.mix->texture] = true;
            if (material.normal_map)
                material.normal_map->texture += textures;
            if (auto& maps = material.maps)
                for (uint32_t* map :
                     {&maps->reflection, &maps->width, &maps->emission, &maps->metallic})
                    *map += *map == kNone ? 0 : textures;
            for (std::optional<PlacedTexture>* placed : {&material.texture, &material.mix})
                if (*placed)
                    (*placed)->texture += textures;
            move_media(material.media, textures);
        }
        for (size_t t = 0; t < scene.textures.size(); ++t) {
            for (TextureStop& stop : scene.textures[t].stops)
                stop.texture += stop.texture == kNoTexture ? 0 : mixes[t] ? materials : textures;
            for (FormulaStep& step : scene.textures[t].pattern.formula.steps)
                if (step.kind >= FormulaStep::Kind::Value)
                    step.index += textures;
        }
        for (PlacedTexture& layer : scene.background.layers)
            layer.texture += textures;
        for (Light& light : scene.lights)
            if (light.thrown)
                light.thrown->texture.texture += textures;
        move_media(scene.background.media, textures);
    }

    static void move_media(std::vector<Medium>& media, uint32_t textures) {
        for (Medium& medium : media)
            for (PlacedTexture& density : medium.densities)
                density.texture += textures;
    }

    static void move_bumps(Scene& scene, uint32_t textures, uint32_t bumps) {
        const auto move = [&](Bump& bump) {
            bump.pattern.texture += textures;
            for (uint32_t& part : bump.parts)
                part += bumps;
        };
        std::for_each(scene.bumps.begin(), scene.bumps.end(), move);
        for (Material& material : scene.materials)
            if (material.bump)
                move(*material.bump);
        if (scene.camera && scene.camera->bump)
            move(*scene.camera->bump);
    }

    template <class T>
    void take_first(std::optional<T>& first, std::optional<T>& next, const std::string& name,
                    std::string_view what) const {
        if (first && next)
            warn(name, what);
        else if (next)
            first = std::move(next);
    }

    void take_background(const Scene& scene, const std::string& name) {
        const Background none;
        if (scene.background == none || scene.background == all_.background)
            return;
        if (all_.background != none)
            warn(name, "background");
        else
            all_.background = scene.background;
    }

    /// Takes the first gamma that is not 1: files without colors of their own have a gamma of 1.
    void take_gamma(const Scene& scene, const std::string& name) {
        if (all_.gamma == 1) {
            all_.gamma = scene.gamma;
            all_.exposure = scene.exposure;
        } else if (scene.gamma != 1 && scene.gamma != all_.gamma) {
            warn(name, "gamma");
        }
    }

    void add_instancing(const Scene& scene) {
        const uint64_t triangles = scene.soup.triangle_count();
        if (all_.instancing || scene.instancing) {
            const Instancing more = scene.instancing.value_or(Instancing{triangles, 0});
            Instancing& sum =
                all_.instancing ? *all_.instancing : all_.instancing.emplace(triangles_, 0);
            sum.unique_triangles += more.unique_triangles;
            sum.instances += more.instances;
        }
        triangles_ += triangles;
    }

    const LogSink& log_;
    Scene all_;
    uint32_t light_groups_ = 0; // in all_
    uint64_t triangles_;
};

} // namespace

Scene join(std::vector<NamedScene> scenes, const LogSink& log) {
    assert(!scenes.empty());
    if (scenes.size() == 1)
        return std::move(scenes[0].scene);
    Joining joining(std::move(scenes[0]), log);
    for (size_t i = 1; i < scenes.size(); ++i)
        joining.add(std::move(scenes[i]));
    return joining.take();
}

} // namespace ovc
