// SPDX-License-Identifier: Apache-2.0
// The interpreter executes directive after directive, until there is a world.
#pragma once

#include "importers/importer.h"
#include "importers/pbrt/interpret/graphics_state.h"
#include "importers/pbrt/look/alphas.h"
#include "importers/pbrt/look/camera.h"
#include "importers/pbrt/look/materials.h"
#include "importers/pbrt/objects.h"
#include "importers/pbrt/shapes/shapes.h"
#include "importers/pbrt/streamed_shapes.h"

#include <string_view>
#include <unordered_map>

namespace ovc::pbrt {

class Interpreter {
public:
    /// streamed: takes the world's own shapes; null where the world is to hold them.
    Interpreter(Tokens& tokens, Diagnostics& diagnostics, const ImportOptions& options,
                StreamedShapes* streamed)
        : tokens_(tokens), diagnostics_(diagnostics), options_(options), streamed_(streamed) {}

    /// Reads everything, once. Returns false after an error, which the diagnostics hold.
    bool run();

    /// Returns the world's triangles, after run().
    World take_world() { return std::move(world_); }
    /// Fills in the rest of the scene, after run(): materials, lights, camera, size.
    void fill(Scene& scene);

private:
    using Action = bool (Interpreter::*)();
    struct Directive {
        std::string_view name;
        Action action;
    };
    static const Directive kDirectives[];

    bool directive();
    /// Handles a directive outside of the world that was asked for; returns false as above.
    bool pass_over(std::string_view name);
    bool unknown(const std::string& name);
    /// Skips the arguments of the directive at hand.
    bool pass_over();

    // Arguments.
    bool read_numbers(size_t count, double* to);
    bool read_text(std::string& to);
    /// of: the kind of directive, whose defaults the parameters get; empty: it has none.
    bool read_typed(std::string& type, Parameters& parameters, std::string_view of = {});

    // Transforms: interpreter_transforms.cpp.
    bool identity();
    bool translate();
    bool scale();
    bool rotate();
    bool look_at();
    bool set_transform();
    bool concatenate();
    bool active_transform();
    bool coordinate_system();
    bool coord_sys_transform();

    // Scopes and files.
    bool attribute();
    bool attribute_begin();
    bool attribute_end();
    bool transform_begin();
    bool transform_end();
    bool begin(Scope scope);
    bool end(Scope scope, std::string_view name);
    /// Ends the scopes of names that began since.
    void end_names(const GraphicsState::Names& begin);
    bool reverse_orientation();
    bool object_begin();
    bool object_end();
    bool object_instance();
    bool include();
    bool import();
    bool world_begin();
    bool world_end();

    // Parts of the scene.
    bool shape();
    bool material();
    bool make_named_material();
    bool named_material();
    void tell_material(const Parameters& parameters, std::string_view type);
    bool texture();
    bool light_source();
    bool area_light_source();
    bool camera();
    bool film();
    bool color_space();
    bool medium();
    bool make_named_medium();
    void tell_media();
    bool medium_interface();
    /// Skips a directive that says how to compute a picture, not what is in the scene.
    bool setting();
    bool bare_setting();

    /// Returns where these transforms are at the picture's moment.
    dmat4 now_at(const Transforms& transforms);
    /// Returns which rays see a shape with these parameters; nothing if none does.
    std::optional<Sight> sight_of(const Parameters& parameters);
    bool add_shape(Mesh mesh, const Sight& sight);
    bool store(Shape shape);
    bool bind_late_instances();
    Object& object() { return building_.empty() ? world_.top : building_.back(); }

    Tokens& tokens_;
    Diagnostics& diagnostics_;
    const ImportOptions& options_;
    StreamedShapes* const streamed_;
    Place place_; // of the directive at hand
    bool known_one_ = false;
    bool moves_ = false; // a transform of something in the scene does
    bool at_end_ = false;
    uint64_t worlds_ = 0;       // worlds that have begun
    bool world_ended_ = false;  // by WorldEnd, which v4 does not have
    bool passing_over_ = false; // inside a world that is not asked for, or behind the one that is

    StateStack state_;
    std::unordered_map<std::string, Transforms> systems_;
    std::unordered_map<std::string, vec3> absorbing_; // media by name, and what they absorb
    Textures textures_{diagnostics_, tokens_};
    Alphas alphas_{textures_, tokens_, diagnostics_};
    Materials materials_{textures_, diagnostics_};
    Lights lights_{textures_, diagnostics_};
    Film film_;
    std::optional<CameraRequest> camera_;

    World world_;
    std::vector<Object> building_; // objects that have begun, the innermost last
    std::unordered_map<std::string, uint32_t> object_ids_;
    struct LateInstance {
        std::string name;
        dmat4 place;
        Place where;
    };
    std::vector<LateInstance> late_; // instances of objects that were not there yet
    uint64_t triangles_ = 0;         // of all shapes so far
};

} // namespace ovc::pbrt
