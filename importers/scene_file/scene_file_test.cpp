// SPDX-License-Identifier: Apache-2.0
// Scene files give back every field; damage is an error, whatever it hits; readers tell which files
// have changed since.
#include "importers/scene_file/scene_file.h"

#include "core/file/value_bytes.h"
#include "importers/file/picture_path.h"
#include "importers/readers.h"
#include "importers/scene_file/scene_fields.h"
#include "importers/test_files.h"
#include "tests/fuzz/importers.h"

#include <random>

namespace ovc {
namespace {

/// Returns every field except the corners, as bytes, which are equal if the scenes are.
std::vector<std::byte> fields_of(const Scene& scene) {
    ByteWriter writer;
    writer(scene, scene.meshes);
    for (const MeshInfo& mesh : scene.meshes)
        writer(mesh.normals, mesh.uv);
    return {writer.bytes().begin(), writer.bytes().end()};
}

void expect_same(const Scene& a, const Scene& b) {
    EXPECT_EQ(fields_of(a), fields_of(b));
    ASSERT_EQ(a.soup.chunks.size(), b.soup.chunks.size());
    for (size_t m = 0; m < a.soup.chunks.size(); ++m) {
        EXPECT_EQ(a.soup.chunks[m].origin(), b.soup.chunks[m].origin());
        EXPECT_EQ(a.soup.chunks[m].mask(), b.soup.chunks[m].mask());
        EXPECT_TRUE(std::ranges::equal(bytes_of(a.soup.chunks[m].corners()),
                                       bytes_of(b.soup.chunks[m].corners())));
    }
}

TEST(SceneFile, GivesBackEveryField) {
    const TestFolder folder;
    const Scene scene = scene_with_everything();
    const Provenance from{"asked", {{"/a/b", true, 7, 8}}, {"one", "two"}};
    const SaveLevels levels = [](const ByteSink& sink) -> Result<Done> {
        sink(bytes_of(std::span<const char>("levels", 6)));
        return Done{};
    };
    ASSERT_TRUE(write_scene_file(scene, from, levels, folder / "a.ovc"));
    const auto file = read_scene_file(folder / "a.ovc");
    ASSERT_TRUE(file) << file.error().message;
    expect_same(scene, file->scene);
    EXPECT_EQ(file->scene.materials, scene.materials);
    EXPECT_EQ(file->scene.cutouts, scene.cutouts);
    EXPECT_EQ(file->scene.textures, scene.textures);
    EXPECT_EQ(file->scene.pictures, scene.pictures);
    EXPECT_EQ(file->scene.camera->window->bend, ImageWindow::Bend::Omnimax);
    EXPECT_EQ(file->from.request, "asked");
    EXPECT_EQ(file->from.files, from.files);
    EXPECT_EQ(file->from.warnings, from.warnings);
    EXPECT_TRUE(
        std::ranges::equal(file->scene.saved, bytes_of(std::span<const char>("levels", 6))));
    EXPECT_EQ(reinterpret_cast<uintptr_t>(file->scene.saved.data()) % kPartAlignment, 0u);
}

const std::vector<vec3> kTwoTriangles{{0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                      {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};

/// Returns a scene whose mesh "a" has these corners, and normals.
Scene scene_of_two_triangles() {
    Scene scene;
    scene.name = "three";
    scene.materials.emplace_back();
    scene.add_mesh("a", 0, Chunk::owning(dvec3(1, 2, 3), kTwoTriangles),
                   std::vector<vec3>(6, vec3(0, 0, 1)));
    return scene;
}

/// Corners and normals that lie in a store make the same file as those that a scene holds.
TEST(SceneFile, IsTheSameOfAStore) {
    const TestFolder folder;
    Scene held = scene_of_two_triangles();
    held.add_mesh("b", 0, Chunk::owning(dvec3(0), {}));
    held.add_mesh("c", 0,
                  Chunk::owning(dvec3(4), {kTwoTriangles.begin(), kTwoTriangles.begin() + 3}));
    Scene empty;
    empty.name = held.name;
    empty.materials = held.materials;
    Result<TriangleStore> store = TriangleStore::create(folder / "");
    ASSERT_TRUE(store);
    for (size_t m = 0; m < held.meshes.size(); ++m) {
        store->begin_mesh();
        EXPECT_TRUE(store->add_corners(held.soup.chunks[m].corners()) &&
                    store->add_normals(held.meshes[m].normals));
        empty.add_mesh(held.meshes[m].name, 0, Chunk::owning(held.soup.chunks[m].origin(), {}));
    }
    ASSERT_TRUE(store->finish());
    ASSERT_TRUE(write_scene_file(held, {}, {}, folder / "held.ovc"));
    ASSERT_TRUE(write_scene_file(empty, *store, {}, {}, folder / "stored.ovc"));
    EXPECT_EQ(folder.read("held.ovc"), folder.read("stored.ovc"));
    const auto file = read_scene_file(folder / "stored.ovc");
    ASSERT_TRUE(file) << file.error().message;
    expect_same(held, file->scene);
}

/// Corners and levels stay on the disk, and are read from there.
TEST(SceneFile, IsTheSameSceneOnADisk) {
    const TestFolder folder;
    Scene held = scene_of_two_triangles();
    held.add_mesh("b", 0, held.soup.chunks[0].instance());
    Transform moved = kIdentity;
    moved.rows[1][3] = 5;
    held.soup.chunks[1].place(moved);
    held.add_mesh("c", 0,
                  Chunk::owning(dvec3(4), {kTwoTriangles.begin() + 1, kTwoTriangles.begin() + 4}));
    const std::string levels = "what was built";
    ASSERT_TRUE(write_scene_file(
        held, {},
        [&](const ByteSink& sink) {
            sink(bytes_of(std::span<const char>(levels)));
            return Result<Done>(Done{});
        },
        folder / "a.ovc"));
    const auto file = open_scene_file(folder / "a.ovc", 1 << 20);
    ASSERT_TRUE(file) << file.error().message;
    const Scene& scene = file->scene;
    ASSERT_EQ(scene.soup.chunks.size(), 3u);
    for (size_t m = 0; m < 3; ++m) {
        const Chunk &a = held.soup.chunks[m], &b = scene.soup.chunks[m];
        const PerCorner<vec3> normals = scene.normals_of(scene.meshes[m]);
        EXPECT_TRUE(scene.meshes[m].normals.empty());
        ASSERT_EQ(normals.size(), held.meshes[m].normals.size());
        for (uint32_t prim = 0; 3 * prim < normals.size(); ++prim)
            for (size_t i = 0; i < 3; ++i)
                EXPECT_EQ(normals.of(prim)[i], held.meshes[m].normals[3 * prim + i]);
        EXPECT_TRUE(b.stored_corners() && b.corners().empty());
        ASSERT_EQ(a.size(), b.size());
        for (uint32_t prim = 0; prim < a.size(); ++prim)
            EXPECT_EQ(a.triangle(prim), b.triangle(prim));
    }
    EXPECT_EQ(scene.soup.chunks[0].mesh_key(), scene.soup.chunks[1].mesh_key());
    EXPECT_EQ(checksum_of(scene), checksum_of(held));
    ASSERT_TRUE(scene.on_disk);
    std::string read(scene.on_disk->levels_bytes, ' ');
    EXPECT_TRUE(scene.on_disk->file.read(scene.on_disk->levels_offset,
                                         std::as_writable_bytes(std::span(read))));
    EXPECT_EQ(read, levels);
    EXPECT_FALSE(scene.on_disk->file.error());
    EXPECT_TRUE(scene.on_disk->checked<Done>(Done{}));
    const auto again = open_scene_file(folder / "a.ovc", 1 << 20);
    ASSERT_TRUE(again);
    std::filesystem::resize_file(folder / "a.ovc", 200);
    again->scene.soup.triangle({2, 0});
    const auto checked = again->scene.on_disk->checked<Done>(Done{});
    ASSERT_FALSE(checked);
    EXPECT_EQ(checked.error().message,
              (folder / "a.ovc").string() +
                  ": triangles 0 to 0: the corners cannot be read: bytes are missing");
}

/// A field that each_field() forgets would be equal in the test above.
TEST(SceneFile, EveryFieldOfAStructIsNamed) {
    const auto size = [](const auto& value) {
        ByteWriter writer;
        writer(value);
        return writer.bytes().size();
    };
    // These are the sizes in memory without padding; optionals and strings count by their parts.
    EXPECT_EQ(size(Finish{}), sizeof(Finish) - 3 * 3 - 2 * 4);
    // Vectors take 8 bytes for their size.
    EXPECT_EQ(size(Pattern{}), sizeof(Pattern) - sizeof(std::vector<TextureStep>) + 8 -
                                   sizeof(Formula) + 2 * 8 - sizeof(DensityGrid) + 12 + 8 -
                                   sizeof(Region) + 4 * 8 + 4);
    EXPECT_EQ(size(TextureStop{}), sizeof(TextureStop));
    EXPECT_EQ(size(PlacedTexture{}), sizeof(PlacedTexture) - 4);
    EXPECT_EQ(size(Background{}), 24 + 8 + 1 + 1 + 8 + 8 + 8u);
    EXPECT_EQ(size(Material{}),
              8 + 12 + 4 + 4 + 12 + 8 + 1 + 1 + 1 + 1 + 1 + 1 + 4 + 1 + 8 + 1 + 4 + 4 + 1u);
    EXPECT_EQ(size(ImageTexture{}), sizeof(ImageTexture) - 4 - 3 - sizeof(ImageTexture::lookup));
    EXPECT_EQ(size(NormalMap{}), sizeof(NormalMap) - 4);
    EXPECT_EQ(size(MaterialMaps{}), sizeof(MaterialMaps));
    EXPECT_EQ(size(PictureFile{}), 8 + 8 + 8u);
    EXPECT_EQ(size(Bump{}), sizeof(Bump) - 4 - 7 - 2 * sizeof(std::vector<uint32_t>) + 2 * 8);
    EXPECT_EQ(size(Rainbow{}), sizeof(Rainbow) - sizeof(std::vector<TextureStop>) + 8);
    EXPECT_EQ(size(SpotCone{}), sizeof(SpotCone));
    EXPECT_EQ(size(LightBeam{}), sizeof(LightBeam));
    EXPECT_EQ(size(ThrownPicture{}), sizeof(ThrownPicture) - 4 - 7);
    EXPECT_EQ(size(Optics{}), 4 * 12 + 1 + 1 + 8 + 4 + 12 + 1u);
    EXPECT_EQ(size(Light{}), 24 + 12 + 24 + 1 + 4 + 8 + 4 + 1 + 24 + 7 * 1 + 8 + 8 + 1 + 1 + 1u);
    EXPECT_EQ(size(ImageWindow{}), 3 * 24 + 1 + 4 + 8 + 8 + 8u);
    EXPECT_EQ(size(Camera{}), 3 * 24 + 8 + 1 + 1 + 1 + 1 + 8 + 1u);
    EXPECT_EQ(size(FaceMesh{}), 8 + 8 + 8u);
    EXPECT_EQ(size(FaceCamera{}), 8 + 8 + 8 + 1u);
    EXPECT_EQ(size(Medium{}), 3 * 12 + 4 + 8 + 4 + 8 + 4 * 4u);
    EXPECT_EQ(size(Cutout{}), 4 + 4 + 8 + 4 + 16 + 16 + 1 + 1 + 1 + 4 + 4u);
    // stored_… are of one process.
    EXPECT_EQ(size(MeshInfo{}), 8 + 4 + 4 + 1 + 1 + 4 + 72 + 3 * 4 + 8 + 8u);
    EXPECT_EQ(sizeof(Finish), 144u) << "a field more: name it in scene_fields.h, and here";
    EXPECT_EQ(sizeof(Optics), 88u) << "a field more: name it in scene_fields.h, and here";
    EXPECT_EQ(sizeof(Material), 856u) << "a field more: name it in scene_fields.h, and here";
    EXPECT_EQ(sizeof(Light), 440u) << "a field more: name it in scene_fields.h, and here";
    EXPECT_EQ(sizeof(ImageWindow), 104u) << "a field more: name it in scene_fields.h, and here";
    EXPECT_EQ(sizeof(Camera), 472u) << "a field more: name it in scene_fields.h, and here";
    EXPECT_EQ(sizeof(Cutout), 88u) << "a field more: name it in scene_fields.h, and here";
    EXPECT_EQ(sizeof(MeshInfo), 224u) << "a field more: name it in scene_fields.h, and here";
}

/// The test takes every seventh byte, because it goes through files; Archive's own test takes every
/// bit.
TEST(SceneFile, ChangedBytesAndMissingEndsAreErrorsOrHarmless) {
    const TestFolder folder;
    const Scene scene = scene_with_everything();
    ASSERT_TRUE(save(scene, folder / "a.ovc"));
    const std::string whole = folder.read("a.ovc");
    for (size_t i = 0; i < whole.size(); i += 7) {
        std::string damaged = whole;
        damaged[i] ^= 0x20;
        const auto found = load(folder.write("b.ovc", damaged));
        if (found)
            expect_same(scene, *found); // between parts
        else
            EXPECT_EQ(found.error().message.find((folder / "b.ovc").string() + ": the file "), 0u);
        EXPECT_FALSE(load(folder.write("c.ovc", whole.substr(0, i)))) << i;
    }
}

/// The fuzzer does the same for longer.
TEST(SceneFile, DamageBehindRightChecksumsIsAnErrorOrASoundScene) {
    for (uint32_t seed = 0; seed < 3000; ++seed) {
        std::mt19937 random(seed);
        std::vector<uint8_t> orders(1 + 6 * (1 + random() % 4) + (random() % 16 == 0));
        for (uint8_t& byte : orders)
            byte = uint8_t(random());
        fuzz_ovc(orders.data(), orders.size());
    }
}

/// Whoever evaluates a material goes down through those below it and through what it mixes.
TEST(SceneFile, CoatsTooDeepInEachOtherAreAnError) {
    const TestFolder folder;
    const auto is_read = [&](size_t materials, bool mix) {
        Scene scene;
        for (size_t m = 0; m < materials; ++m) {
            Material material;
            if (m > 0 && mix) {
                Texture texture;
                texture.stops = {{0, {}, uint32_t(m - 1)}, {1, {}, 0}};
                material.mix = placed_in_world(uint32_t(scene.textures.size()));
                scene.textures.push_back(std::move(texture));
            } else if (m > 0)
                material.under = uint32_t(m - 1);
            scene.materials.push_back(std::move(material));
        }
        EXPECT_TRUE(save(scene, folder / "a.ovc"));
        return bool(load(folder / "a.ovc"));
    };
    for (const bool mix : {false, true}) {
        EXPECT_TRUE(is_read(500, mix)) << mix;
        EXPECT_FALSE(is_read(20000, mix)) << mix;
    }
}

/// What is below a mix of materials is seen once, whatever part of the mix is seen.
TEST(SceneFile, LayersOfManyMixesAreFine) {
    Scene scene;
    scene.materials.resize(10);
    for (uint32_t layer = 0; layer < 10; ++layer) {
        Texture texture;
        for (uint32_t i = 0; i < 10; ++i)
            texture.stops.push_back({i / 9.0, {}, i});
        Material material;
        material.mix = placed_in_world(layer);
        material.under = layer == 0 ? kNone : uint32_t(scene.materials.size() - 1);
        scene.textures.push_back(std::move(texture));
        scene.materials.push_back(std::move(material));
    }
    const TestFolder folder;
    ASSERT_TRUE(save(scene, folder / "a.ovc"));
    EXPECT_TRUE(load(folder / "a.ovc"));
}

TEST(SceneFile, ErrorsNameTheFile) {
    const TestFolder folder;
    const auto message = [&](const std::filesystem::path& path) {
        const auto found = load(path);
        return found ? std::string() : folder.plain(found.error().message);
    };
    EXPECT_EQ(message(folder / "none.ovc"), "none.ovc: no such file");
    EXPECT_EQ(message(folder.write("empty.ovc", "")),
              "empty.ovc: the file is empty, expected a scene");
    EXPECT_EQ(message(folder.write("text.ovc", std::string(200, 'x'))),
              "text.ovc: the file does not begin as ovc scene does");
    EXPECT_EQ(message(folder.write("short.ovc", "ovc scene")),
              "short.ovc: the file is too short to be whole");
}

TEST(SceneFile, AChangedSourceIsTold) {
    const TestFolder folder;
    FilesRead read;
    read.note(folder.write("a.ply", "ply"));
    read.note(folder / "later.mtl");
    Provenance from{"", read.stamps(), {"said before"}};
    EXPECT_EQ(from.changed_file(), nullptr);
    ASSERT_TRUE(write_scene_file(scene_with_everything(), from, {}, folder / "a.ovc"));
    const auto warnings_now = [&] {
        std::vector<std::string> warnings;
        EXPECT_TRUE(load(folder / "a.ovc", gather(warnings)));
        return warnings;
    };
    EXPECT_EQ(warnings_now(), std::vector<std::string>{"said before"});
    folder.write("later.mtl", "newmtl a");
    ASSERT_EQ(warnings_now().size(), 2u);
    EXPECT_NE(warnings_now()[1].find("later.mtl as that was before it changed"), std::string::npos);
    std::filesystem::remove(folder / "later.mtl");
    EXPECT_EQ(warnings_now().size(), 1u);
    folder.write("a.ply", "ply ");
    EXPECT_EQ(warnings_now().size(), 2u);
}

/// Readers note the files that they open, and those that they would have opened.
TEST(SceneFile, ReadersSayWhatTheyRead) {
    const TestFolder folder;
    folder.write("a.obj", "mtllib a.mtl none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write("a.mtl", "newmtl a\n");
    ASSERT_TRUE(save(*load(folder / "a.obj"), folder / "mesh.ply"));
    folder.write("a.pbrt", "Include \"b.pbrt\" Shape \"plymesh\" \"string filename\" \"mesh.ply\"\n"
                           "Shape \"plymesh\" \"string filename\" \"gone.ply\"\n");
    folder.write("b.pbrt", "WorldBegin\n");
    folder.write("a.pov", "#include \"b.inc\"\nsphere { 0, 1 }\n");
    folder.write("b.inc", "#declare A = 1;\n");
    const auto read_by = [&](const char* name) {
        FilesRead files;
        ImportOptions options;
        options.files = &files;
        EXPECT_TRUE(load(folder / name, options)) << name;
        std::vector<std::string> found;
        for (const FileStamp& stamp : files.stamps())
            found.push_back((stamp.exists ? "" : "no ") +
                            std::filesystem::path(stamp.path).filename().string());
        return found;
    };
    using Names = std::vector<std::string>;
    EXPECT_EQ(read_by("a.obj"), (Names{"a.obj", "no a.mtl none.mtl", "a.mtl", "no none.mtl"}));
    EXPECT_EQ(read_by("mesh.ply"), (Names{"mesh.ply"}));
    EXPECT_EQ(read_by("a.pbrt"),
              (Names{"a.pbrt", "b.pbrt", "mesh.ply", "no gone.ply", "no gone.ply.gz"}));
    EXPECT_EQ(read_by("a.pov"), (Names{"a.pov", "b.inc"}));
}

} // namespace
} // namespace ovc
