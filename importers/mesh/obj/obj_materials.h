// SPDX-License-Identifier: Apache-2.0
// ObjMaterials: the materials of an OBJ file, whose libraries are read where the file names them.
#pragma once

#include "core/function_ref.h"
#include "core/result.h"
#include "core/scene.h"
#include "importers/importer.h"
#include "importers/mesh/obj/mtl.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace ovc {

class ObjMaterials {
public:
    /// Says the sentence at the first call with this kind only.
    using Warn = FunctionRef<void(const std::string& kind, const std::string& sentence)>;

    /// path: of the OBJ file. Both outlive this.
    ObjMaterials(const std::filesystem::path& path, const ImportOptions& options)
        : path_(path), log_(options.log), files_read_(options.files) {}

    /// Reads the libraries of a statement: one name with blanks in it, or several names; a blank
    /// may be written '\ '. has_uv: the file had texture coordinates before. Error: a library is
    /// damaged.
    Result<Done> read_libraries(std::string_view names, bool has_uv, const Warn& warn);

    /// Returns the number of a material, which becomes grey where no library has it, or will have.
    /// line: that uses it.
    uint32_t find(std::string_view name, uint64_t line);

    /// Returns whether textures of the material need texture coordinates.
    bool has_textures(uint32_t number) const { return !materials_[number].shown.empty(); }
    /// Returns whether texture coordinates are of use: a library has textures, or none was read.
    bool keeps_uv() const { return keeps_uv_; }

    /// Warns of the materials that are used, because a library may serve many files.
    void say_left_out(const std::vector<bool>& used, const Source& source) const;

    /// Adds the materials to the scene, with the textures of those that are used. Returns for each
    /// the cutout of its textures, or kNone.
    std::vector<uint32_t> add_to(Scene& scene, const std::vector<bool>& used) const;

    size_t size() const { return materials_.size(); }

private:
    bool read_library(std::string_view name, bool has_uv);

    const std::filesystem::path& path_;
    const LogSink& log_;
    FilesRead* const files_read_;
    std::vector<LibraryMaterial> materials_{LibraryMaterial{}}; // the first before any usemtl
    std::unordered_map<std::string, uint32_t> numbers_;         // by name
    std::unordered_set<std::string> libraries_;                 // paths that were read
    bool any_textures_ = false;
    bool keeps_uv_ = true;
    Result<Done> libraries_done_ = Done{}; // an error where a library is damaged
};

} // namespace ovc
