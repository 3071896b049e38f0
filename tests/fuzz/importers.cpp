// SPDX-License-Identifier: Apache-2.0
// Through files in memory, for readers take files.
#include "tests/fuzz/importers.h"

#include "core/file/test_archive.h"
#include "importers/pov/pictures/density.h"
#include "importers/pov/pictures/picture.h"
#include "importers/readers.h"
#include "importers/scene_file/scene_file.h"
#include "importers/scene_file/sound_meshes.h"
#include "tests/fuzz/require.h"

#include <string>
#include <vector>

#include <sys/mman.h>
#include <unistd.h>

namespace ovc {
namespace {

/// A file without a name on any disk, whose bytes can be set anew.
class MemoryFile {
public:
    explicit MemoryFile(const char* name) : file_(memfd_create(name, MFD_CLOEXEC)) {
        require(file_ >= 0);
    }
    MemoryFile(const MemoryFile&) = delete;
    ~MemoryFile() { close(file_); }

    std::string holding(const void* data, size_t size) const {
        require(ftruncate(file_, 0) == 0 && pwrite(file_, data, size, 0) == ssize_t(size));
        return "/proc/self/fd/" + std::to_string(file_);
    }

private:
    const int file_;
};

void check_scene(const Scene& scene) {
    require(has_sound_meshes(scene));
    Box bounds;
    hittable_triangles(scene.soup, nullptr, &bounds); // touches every corner
}

void check(const Result<Scene>& scene) {
    if (scene)
        check_scene(*scene);
    else
        require(!scene.error().message.empty() &&
                scene.error().message.find('\n') == std::string::npos);
}

/// A scene of so few bytes cannot have more: a corner takes a byte, and a polygon of n corners has
/// n - 2 triangles. Packed it can.
void check_size(const Result<Scene>& scene, const uint8_t* data, size_t size) {
    const bool packed = size > 1 && data[0] == 0x1f && data[1] == 0x8b;
    require(!scene || packed || scene->soup.triangle_count() <= size);
}

} // namespace

namespace {

struct CountingSink final : TriangleSink {
    uint64_t corners = 0;
    size_t mesh = 0;
    std::vector<uint64_t> normals; // of each mesh

    void begin_mesh() override {
        normals.push_back(0);
        mesh = normals.size() - 1;
    }
    void go_on_with(size_t which) override {
        require(which < normals.size());
        mesh = which;
    }
    void drop_normals(size_t which) override { normals.at(which) = 0; }
    bool add_corners(std::span<const vec3> some) override {
        corners += some.size();
        return true;
    }
    bool add_normals(std::span<const vec3> some) override {
        normals.at(mesh) += some.size();
        return true;
    }
};

/// A file that streams is refused where one that is held is, or has as many triangles and normals.
void check_stream(const Result<Scene>& held, const std::string& path,
                  Result<Scene> (*read)(const std::filesystem::path&, const ImportOptions&)) {
    CountingSink sink;
    const Streaming streaming{sink, ~uint64_t(0)};
    const Result<Scene> streamed = read(path, {.streaming = &streaming});
    require(bool(held) == bool(streamed));
    require(held || held.error().message == streamed.error().message);
    if (!held)
        return;
    require(sink.corners == 3 * held->soup.triangle_count());
    require(sink.normals.size() == held->meshes.size());
    for (size_t m = 0; m < held->meshes.size(); ++m)
        require(sink.normals[m] == held->meshes[m].normals.size());
}

} // namespace

void fuzz_ply(const uint8_t* data, size_t size) {
    static const MemoryFile file("fuzz.ply");
    const std::string path = file.holding(data, size);
    const Result<Scene> scene = read_ply(path, {});
    check(scene);
    check_size(scene, data, size);
    check_stream(scene, path, read_ply);
}

void fuzz_obj(const uint8_t* data, size_t size) {
    static const MemoryFile file("fuzz.obj");
    const std::string path = file.holding(data, size);
    const Result<Scene> scene = read_obj(path, {});
    check(scene);
    check_size(scene, data, size);
    check_stream(scene, path, read_obj);
}

/// The first bytes tell the format of a picture.
void fuzz_pictures(const uint8_t* data, size_t size) {
    static const MemoryFile file("fuzz.png");
    const std::string path = file.holding(data, size);
    const Result<Picture> picture = pov::read_picture(path);
    require(picture || !picture.error().message.empty());
    if (picture)
        require(picture->pixels.size() == picture->size() &&
                (picture->indices.empty() || picture->indices.size() == picture->size()));
    const Result<DensityGrid> grid = pov::read_density(path);
    require(grid || !grid.error().message.empty());
}

/// Adds patterns and pictures to the scene's materials and to its sky.
static void add_textures(Scene& scene) {
    Pattern marble{.kind = Pattern::Kind::Marble, .turbulence = dvec3(0.5)};
    marble.steps.resize(2);
    marble.steps[1].kind = TextureStep::Kind::Repeat;
    scene.textures = {{marble, {{0, {vec3(1)}}, {1, {vec3(0.5f), 0.25f}}}},
                      {marble, {{0, {}, 0}, {1, {}, 0}}},
                      {marble, {{0, {}, 0}, {1, {}, 1}}}};
    scene.pictures = {{"/a.png", "a.pbrt:1", {}}, {"b.glb, picture *0", "", {1, 2, 3}}};
    Texture image{.kind = TextureKind::Image, .on_uv = true, .image = ImageTexture{.picture = 1}};
    image.image->projection = ImageTexture::Projection::Torus;
    image.image->channel = ImageTexture::Channel::CodedMask;
    image.image->per = ImageTexture::Measure::ThroughWindow;
    image.image->window_distance = 2;
    scene.textures.push_back(image);
    scene.textures.push_back(
        {.stops = {{0, {}, 0}, {0, {}, 3}, {0, {vec3(1)}}}, .kind = TextureKind::Mix});
    scene.materials[0].texture = PlacedTexture{4};
    scene.materials[1].texture = PlacedTexture{1};
    scene.materials[1].maps = MaterialMaps{.width = 3};
    scene.materials[1].normal_map = NormalMap{.kind = NormalMap::Kind::Texels, .texture = 3};
    scene.materials[1].bump = Bump{.kind = Bump::Kind::Dents};
    scene.materials.push_back({.name = "mixed", .under = 1, .mix = PlacedTexture{2}});
    scene.background.layers = {PlacedTexture{0}};
    scene.background.layers_add = true;
    scene.materials[1].optics = Optics{.diffuse_behind = vec3(0.25f)};
}

Scene scene_with_everything() {
    Scene scene;
    scene.name = "everything";
    scene.materials.push_back({"plain"});
    scene.materials.push_back({"shiny", vec3(0.1f, 0.2f, 0.3f), 0.5f, 0.25f, vec3(0.5f), 1.5,
                               Finish{vec3(0.1f)},
                               Optics{.diffuse = vec3(0.3f), .boundary = Optics::Boundary::Thin}});
    add_textures(scene);
    const std::vector<vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                       {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    scene.add_mesh("a", 0, Chunk::owning(dvec3(0), corners), std::vector<vec3>(6, vec3(0, 0, 1)));
    scene.add_mesh("b", 1, Chunk::owning(dvec3(1e6, 0, 0.125), corners));
    scene.meshes[1].normals_from = 0;
    scene.meshes[1].turn = dmat3(2);
    scene.show(1, kSeenByCamera);
    scene.cutouts = {{.width = 2, .height = 1, .opacity = {0, 255}},
                     {.width = 1, .height = 1, .opacity = {9}, .smooth = true},
                     {.texture = 3, .threshold = 0.5f}};
    scene.meshes[0].cutout = 0;
    scene.meshes[0].uv.assign(6, vec2(0.25f, 1));
    scene.meshes[1].shadow_cutout = 1;
    scene.meshes[1].uv_from = 0;
    scene.add_mesh("", 0, Chunk::owning(dvec3(0), {}));
    Light light;
    light.position = dvec3(1, 2, 3);
    light.cone = SpotCone{0.9, 0.8, 2};
    light.fade_power = 2;
    light.stand_in = true;
    light.thrown = ThrownPicture{{}, true};
    scene.lights = {light, {}};
    scene.may_add_light = false;
    Camera camera;
    camera.window = ImageWindow{};
    camera.window->bend = ImageWindow::Bend::Omnimax;
    scene.camera = camera;
    scene.size = ImageSize{320, 240};
    scene.part = PicturePart{{320, 240}, 10, 20, {100, 50}};
    scene.max_depth = 7;
    scene.samples = 9;
    scene.background.zenith = vec3(0, 0, 1);
    scene.exposure = 0.5f;
    scene.gamma = 2.2;
    scene.instancing = Instancing{2, 2};
    return scene;
}

/// A whole scene file, in memory.
static test::ArchiveMemory written() {
    const std::string path = (std::filesystem::temp_directory_path() /
                              ("overcast-fuzz-" + std::to_string(getpid()) + ".ovc"))
                                 .string();
    const Provenance from{"as asked", {{"/none", false, 0, 0}}, {"a warning"}};
    const auto levels = [](const ByteSink& sink) -> Result<Done> {
        const std::vector<std::byte> some(100, std::byte(7));
        sink(some);
        return Done{};
    };
    require(bool(write_scene_file(scene_with_everything(), from, levels, path)));
    const Result<MappedFile> file = MappedFile::open(path);
    require(bool(file));
    test::ArchiveMemory memory(file->bytes());
    require(unlink(path.c_str()) == 0);
    return memory;
}

void fuzz_ovc(const uint8_t* data, size_t size) {
    static const test::ArchiveMemory whole = written();
    if (size == 0)
        return;
    test::ArchiveMemory memory(whole.bytes());
    test::damage(memory, {data + 1, size - 1});
    if (data[0] % 2)
        test::reseal(memory);
    const MemoryFile file("fuzz.ovc"); // mapped as long as the scene lives: a new one each time
    const std::string path = file.holding(memory.bytes().data(), memory.size());
    check(read_ovc(path, {}));
    ImportOptions on_disk;
    on_disk.host_bytes = 1 << 20;
    check(read_ovc(path, on_disk));
}

} // namespace ovc
