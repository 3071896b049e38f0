// SPDX-License-Identifier: Apache-2.0
// Assimp reads every other format; no other file sees it. It never reads .ply and .obj: there it
// takes many times the memory of the file, and hangs or crashes on some that are damaged.
#include "core/text/lower_case.h"
#include "importers/file/source.h"
#include "importers/file/text.h"
#include "importers/mesh/assimp_look.h"
#include "importers/mesh/assimp_meshes.h"
#include "importers/mesh/gltf.h"
#include "importers/pbrt/look/exposure.h"
#include "importers/readers.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/importerdesc.h>
#include <assimp/scene.h>
#include <assimp/version.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>
#include <numbers>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace Assimp {

/// Assimp calls its own function of this name where a file leads it astray, and that ends the
/// process. The loader takes this one in its place, and Assimp makes an error of what it throws.
/// Where Assimp was linked with -Bsymbolic, it keeps its own.
[[gnu::visibility("default")]] void aiAssertViolation(const char*, const char*, int);

void aiAssertViolation(const char* expression, const char*, int) {
    throw std::logic_error(fmt::format("it expected {}", expression));
}

} // namespace Assimp

namespace ovc {

namespace {

dvec3 through(const aiMatrix4x4& place, const aiVector3D& point) {
    const aiVector3D moved = place * point;
    return {moved.x, moved.y, moved.z};
}

/// Returns the angle along the shorter side of the picture; where a glTF tells no shape, the
/// upright one, which it then has in every picture. Assimp tells the whole angle across, whatever
/// its header says, but before version 5.3 for glTF the upright angle times the shape.
double angle_of_view(const aiCamera& source, bool is_gltf) {
    const double shape = source.mAspect > 0 ? source.mAspect : 1;
    const unsigned major = aiGetVersionMajor();
    const bool by_shape = is_gltf && (major < 5 || (major == 5 && aiGetVersionMinor() < 3));
    const double upright = by_shape ? std::tan(source.mHorizontalFOV / shape / 2)
                                    : std::tan(source.mHorizontalFOV / 2) / shape;
    return 2 * std::atan(upright * std::min(shape, 1.0));
}

/// Places the camera where its node stands. Returns nothing for an orthographic camera, whose
/// extent not all formats tell, and for one that no node has or that sees nothing.
std::optional<Camera> camera_from(const aiCamera& source, const aiNode& root, bool is_gltf) {
    const std::optional<aiMatrix4x4> place = place_of(root, source.mName);
    if (!place)
        return std::nullopt;
    // For glTF, Assimp 5 gives the node's own translation once more.
    const aiVector3D at = is_gltf ? aiVector3D() : source.mPosition;
    Camera camera;
    camera.eye = through(*place, at);
    camera.target = through(*place, at + source.mLookAt);
    camera.up = through(*place, at + source.mUp) - camera.eye;
    camera.fov_degrees = angle_of_view(source, is_gltf) * 180 / std::numbers::pi;
    camera.fov_is_upright = is_gltf && !(source.mAspect > 0);
    const bool sees = camera.fov_degrees > 0 && camera.fov_degrees < 180 && is_finite(camera.eye) &&
                      is_finite(camera.target) && camera.eye != camera.target &&
                      is_finite(camera.up);
    return sees ? std::optional(camera) : std::nullopt;
}

/// Returns the first camera that can be used.
std::optional<Camera> camera_of(const aiScene& scene, bool is_gltf) {
    for (unsigned c = 0; c < scene.mNumCameras; ++c)
        if (auto camera = camera_from(*scene.mCameras[c], *scene.mRootNode, is_gltf))
            return camera;
    return std::nullopt;
}

/// Lists each picture once, in the order of the materials; "*0" is the first picture in the file
/// itself.
std::vector<std::string> textures_of(const aiScene& scene) {
    std::vector<std::string> names;
    for (unsigned m = 0; m < scene.mNumMaterials; ++m)
        for (unsigned type = 1; type <= AI_TEXTURE_TYPE_MAX; ++type)
            for (unsigned i = 0; i < scene.mMaterials[m]->GetTextureCount(aiTextureType(type));
                 ++i) {
                aiString path;
                if (scene.mMaterials[m]->GetTexture(aiTextureType(type), i, &path) != AI_SUCCESS ||
                    path.length == 0) // as of an X3D file without a texture
                    continue;
                if (std::find(names.begin(), names.end(), path.C_Str()) == names.end())
                    names.emplace_back(path.C_Str());
            }
    return names;
}

/// Counts points and lines.
uint64_t other_faces(const aiScene& scene) {
    uint64_t others = 0;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m)
        for (unsigned f = 0; f < scene.mMeshes[m]->mNumFaces; ++f)
            others += scene.mMeshes[m]->mFaces[f].mNumIndices < 3;
    return others;
}

uint64_t count_meshes(const aiScene& scene, bool (*counts)(const aiMesh&)) {
    return uint64_t(std::count_if(scene.mMeshes, scene.mMeshes + scene.mNumMeshes,
                                  [&](const aiMesh* mesh) { return counts(*mesh); }));
}

bool is_colored(const aiMesh& mesh) {
    return mesh.HasVertexColors(0);
}

bool is_skinned(const aiMesh& mesh) {
    return mesh.HasBones();
}

bool is_morphed(const aiMesh& mesh) {
    return std::any_of(mesh.mAnimMeshes, mesh.mAnimMeshes + mesh.mNumAnimMeshes,
                       [](const aiAnimMesh* target) { return target->mWeight != 0; });
}

/// Returns a sentence for each kind of thing that the file has and the scene will not. textures:
/// the names of the pictures that are not shown; lights: how many are left out.
std::vector<std::string> left_out_of(const aiScene& found, bool has_camera,
                                     std::vector<std::string> textures, uint64_t lights) {
    constexpr const char* kAtRest = ": meshes are shown in their rest form";
    std::vector<std::string> sentences;
    for (std::string& name : textures)
        name = ovc::quoted(name);
    const auto leave_out = [&](uint64_t count, const char* what, const std::string& more = {}) {
        if (count > 0)
            sentences.push_back(fmt::format("{} left out{}", counted(count, what), more));
    };
    leave_out(textures.size(), "texture", ": " + listed(textures));
    leave_out(found.mNumCameras - (has_camera ? 1 : 0), has_camera ? "more camera" : "camera");
    leave_out(lights, "light");
    leave_out(found.mNumAnimations, "animation", ": what moves is shown at rest");
    leave_out(count_meshes(found, is_skinned), "skin", kAtRest);
    leave_out(count_meshes(found, is_morphed), "set of morph weights", kAtRest);
    leave_out(count_meshes(found, is_colored), "set of vertex colors");
    leave_out(other_faces(found), "face", ": they have fewer than three corners");
    return sentences;
}

/// Opens files for Assimp, and notes each one; one of them may lie in memory.
class NotingFiles final : public Assimp::DefaultIOSystem {
public:
    /// files: may be null.
    explicit NotingFiles(FilesRead* files) : files_(files) {}

    /// bytes: kept by reference.
    void put(const std::string& name, std::string_view bytes) {
        name_ = name;
        bytes_ = bytes;
    }

    bool Exists(const char* file) const override {
        return file == name_ || DefaultIOSystem::Exists(file);
    }

    Assimp::IOStream* Open(const char* file, const char* mode) override {
        if (!name_.empty() && file == name_)
            return new Assimp::MemoryIOStream(reinterpret_cast<const uint8_t*>(bytes_.data()),
                                              bytes_.size());
        if (files_)
            files_->note(file);
        return DefaultIOSystem::Open(file, mode);
    }

private:
    FilesRead* const files_;
    std::string name_;
    std::string_view bytes_;
};

std::filesystem::path plain_name(const std::filesystem::path& path) {
    return path.extension() == ".gz" ? path.stem() : path;
}

bool is_gltf(const std::filesystem::path& path) {
    const std::string extension = lower_case(plain_name(path).extension().string());
    return extension == ".gltf" || extension == ".glb";
}

/// Lets Assimp open a plain file itself, because that may name others beside it; a compressed one
/// is read from memory.
const aiScene* read(Assimp::Importer& importer, Source& source, const std::filesystem::path& path) {
    if (!source.is_compressed())
        return importer.ReadFile(path.string(), 0);
    const std::string extension = plain_name(path).extension().string();
    const std::string all = source.rest();
    return importer.ReadFileFromMemory(all.data(), all.size(), 0,
                                       extension.empty() ? "" : extension.c_str() + 1);
}

/// Reads a glTF file that was made ready, and what it names beside it.
const aiScene* read(Assimp::Importer& importer, NotingFiles& files, const GltfFile& file,
                    const std::filesystem::path& path) {
    std::filesystem::path name = path;
    if (name.extension() == ".gz")
        name.replace_extension();
    name.replace_extension(file.is_binary ? "glb" : "gltf");
    files.put(name.string(), file.bytes);
    return importer.ReadFile(name.string(), 0);
}

/// Takes the pictures in a 3MF file, such as its thumbnail, out of what was read; none is shown.
/// Assimp 5.2.5 to 5.3.1 has deleted them before it returns, and would again.
void drop_deleted_pictures(const Assimp::Importer& importer, const aiScene* found) {
    const int number = importer.GetPropertyInteger("importerIndex", -1);
    const aiImporterDesc* const reader =
        number < 0 ? nullptr : importer.GetImporterInfo(size_t(number));
    const bool deletes = aiGetVersionMajor() == 5 && aiGetVersionMinor() < 4;
    if (!found || !deletes || !reader || std::string_view(reader->mFileExtensions) != "3mf")
        return;
    auto* const scene = const_cast<aiScene*>(found);
    delete[] std::exchange(scene->mTextures, nullptr);
    scene->mNumTextures = 0;
}

/// Throws std::bad_alloc where Assimp ran out of memory, of which it tells the exception's name
/// alone.
void check_memory(const Assimp::Importer& importer) {
    const std::exception_ptr thrown = importer.GetException();
    if (!thrown)
        return;
    try {
        std::rethrow_exception(thrown);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::length_error&) {
        throw std::bad_alloc();
    } catch (...) { // Assimp has a sentence on it
    }
}

} // namespace

bool assimp_reads(std::string_view extension) {
    return Assimp::Importer().IsExtensionSupported(fmt::format(".{}", extension));
}

Result<Scene> read_assimp(const std::filesystem::path& path, const ImportOptions& options) try {
    Result<Source> source = Source::open(path, options.files);
    if (!source)
        return source.error();
    Assimp::Importer importer;
    auto* const files = new NotingFiles(options.files);
    importer.SetIOHandler(files); // the importer deletes it
    GltfFile gltf;
    const aiScene* found = nullptr;
    if (is_gltf(path)) {
        Result<GltfFile> ready = read_gltf_file(*source);
        if (!ready)
            return ready.error();
        gltf = std::move(*ready);
        found = read(importer, *files, gltf, path);
    } else {
        found = read(importer, *source, path);
    }
    check_memory(importer);
    drop_deleted_pictures(importer, found);
    Scene scene;
    scene.name = path.stem().string();
    std::vector<std::string> left_out;
    std::vector<AssimpMaterial> materials;
    if (found) {
        scene.camera = camera_of(*found, is_gltf(path));
        std::vector<std::string> textures = textures_of(*found);
        materials = add_materials(*found, path, scene, textures);
        const uint64_t lights = add_lights(*found, scene);
        left_out = left_out_of(*found, scene.camera.has_value(), std::move(textures), lights);
    }
    if (!found || source->is_damaged())
        return source->error(fmt::format(
            "Assimp found: {}{}", importer.GetErrorString(),
            gltf.has_long_draco ? "; Assimp 5.2 loses indices of 32 bits that Draco unpacks" : ""));
    left_out.insert(left_out.end(), gltf.left_out.begin(), gltf.left_out.end());
    for (const std::string& sentence : left_out)
        say(options.log, LogLevel::Warning, source->error(sentence).message);
    if (scene.materials.empty()) {
        scene.materials.emplace_back();
        materials.emplace_back();
    }
    if (const auto added = add_meshes(*found, materials, materials_on_uv(scene), scene); !added)
        return source->error(added.error().message);
    if (!scene.lights.empty()) {
        scene.exposure = pbrt::fitting_exposure(scene);
        pbrt::expose(scene, vec3(scene.exposure));
    }
    if (scene.soup.triangle_count() == 0)
        say(options.log, LogLevel::Warning, source->error("it has no triangles").message);
    return scene;
} catch (const std::bad_alloc&) {
    throw; // load() has a sentence on it
} catch (const std::exception& e) {
    return Error{fmt::format("{}: Assimp failed: {}", path.string(), e.what())};
}

} // namespace ovc
