// SPDX-License-Identifier: Apache-2.0
// Interpreter: directive after directive, until there is a world.
#pragma once

#include "importers/importer.h"
#include "importers/pbrt/interpret/graphics_state.h"
#include "importers/pbrt/look/camera.h"
#include "importers/pbrt/look/materials.h"
#include "importers/pbrt/objects.h"
#include "importers/pbrt/shapes/shapes.h"

#include <string_view>
#include <unordered_map>

namespace ovc::pbrt {

class Interpreter {
public:
    Interpreter(Tokens& tokens, Diagnostics& diagnostics, const ImportOptions& options)
        : tokens_(tokens), diagnostics_(diagnostics), options_(options) {}

    /// False: an error, in the diagnostics.
    bool run();

    /// After run(). The rest of the scene: materials, lights, camera, size; no triangles.
    World take_world() { return std::move(world_); }
    void fill(Scene& scene);

private:
    using Action = bool (Interpreter::*)();
    struct Directive {
        std::string_view name;
        Action action;
    };
    static const Directive kDirectives[];

    bool directive();
    /// A directive of what is passed over; false as above.
    bool pass_over(std::string_view name);
    bool unknown(const std::string& name);
    /// What stands between the directive at hand and the next.
    bool pass_over();

    // Arguments.
    bool read_numbers(size_t count, double* to);
    bool read_text(std::string& to);
    bool read_typed(std::string& type, Parameters& parameters);

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
    bool attribute_begin();
    bool attribute_end();
    bool transform_begin();
    bool transform_end();
    bool begin(Scope scope);
    bool end(Scope scope, std::string_view name);
    bool reverse_orientation();
    bool object_begin();
    bool object_end();
    bool object_instance();
    bool include();
    bool import();
    bool world_begin();
    bool world_end();

    // What a scene consists of.
    bool shape();
    bool material();
    bool make_named_material();
    bool named_material();
    bool texture();
    bool light_source();
    bool area_light_source();
    bool camera();
    bool film();
    bool medium();
    bool medium_interface();
    /// What concerns how a picture is computed, not the scene: read and left.
    bool setting();
    bool bare_setting();

    bool add_shape(Mesh mesh);
    bool bind_late_instances();
    Object& object() { return building_.empty() ? world_.top : building_.back(); }

    Tokens& tokens_;
    Diagnostics& diagnostics_;
    const ImportOptions& options_;
    Place place_; // of the directive at hand
    bool known_one_ = false;
    bool at_end_ = false;
    uint64_t worlds_ = 0;       // that have begun
    bool passing_over_ = false; // worlds that are not asked for, and what follows the one that is

    StateStack state_;
    std::unordered_map<std::string, Transforms> systems_;
    Textures textures_{diagnostics_};
    Materials materials_{textures_, diagnostics_};
    Lights lights_{textures_, diagnostics_};
    Film film_;
    std::optional<CameraRequest> camera_;

    World world_;
    std::vector<Object> building_; // the innermost last
    std::unordered_map<std::string, uint32_t> object_ids_;
    struct LateInstance {
        std::string name;
        dmat4 place;
        Place where;
    };
    std::vector<LateInstance> late_; // of objects that were not there yet
    uint64_t triangles_ = 0;         // in all shapes
};

} // namespace ovc::pbrt
