// SPDX-License-Identifier: Apache-2.0
// Writers of PLY (binary little endian) and OBJ.
#include "importers/file/output_file.h"
#include "importers/mesh/unique_vertices.h"
#include "importers/readers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <iterator>

namespace ovc {

namespace {

static_assert(std::endian::native == std::endian::little, "PLY is written as it lies in memory");

bool is_float(double value) {
    return double(float(value)) == value || std::isnan(value);
}

bool is_float(const dvec3& v) {
    return is_float(v.x) && is_float(v.y) && is_float(v.z);
}

/// The vertices of some chunks, and three indices per triangle.
struct Indexed {
    UniqueVertices unique;
    std::vector<uint32_t> indices;

    void add(const Chunk& chunk) {
        for (uint32_t prim = 0; prim < chunk.size(); ++prim)
            for (const dvec3& corner : chunk.triangle(prim))
                indices.push_back(unique.add(corner));
    }
};

void write_position(OutputFile& out, const dvec3& v, bool as_floats) {
    const vec3 single(v);
    if (as_floats)
        out.write(&single, sizeof(single));
    else
        out.write(&v, sizeof(v));
}

void append_number(fmt::memory_buffer& text, double value) {
    if (is_float(value))
        fmt::format_to(std::back_inserter(text), " {}", float(value));
    else
        fmt::format_to(std::back_inserter(text), " {}", value);
}

/// Keeps the name on one line, because a line end in it would end its statement.
std::string printable(std::string name) {
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == '\n' || c == '\r' || c == '\\'; }, '_');
    return name;
}

void write_mesh(OutputFile& out, const std::string& name, const Chunk& chunk,
                uint64_t& vertices_above) {
    Indexed mesh;
    mesh.add(chunk);
    assert(mesh.indices.size() == size_t(chunk.size()) * 3);
    out.write(fmt::format("o {}\n", printable(name)));
    fmt::memory_buffer text;
    const auto flush = [&] {
        out.write(text.data(), text.size());
        text.clear();
    };
    for (const dvec3& v : mesh.unique.vertices()) {
        text.push_back('v');
        for (int axis = 0; axis < 3; ++axis)
            append_number(text, v[axis]);
        text.push_back('\n');
        flush();
    }
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        fmt::format_to(
            std::back_inserter(text), "f {} {} {}\n", vertices_above + mesh.indices[i] + 1,
            vertices_above + mesh.indices[i + 1] + 1, vertices_above + mesh.indices[i + 2] + 1);
        flush();
    }
    vertices_above += mesh.unique.vertices().size();
}

} // namespace

Result<Done> write_ply(const Scene& scene, const std::filesystem::path& path) {
    // Indices are written as int, which every reader takes.
    constexpr uint64_t kMaxVertices = 0x7fffffff;
    Result<OutputFile> out = OutputFile::create(path);
    if (!out)
        return out.error();
    Indexed all;
    all.indices.reserve(3 * scene.soup.triangle_count());
    for (const Chunk& chunk : scene.soup.chunks)
        all.add(chunk);
    const std::vector<dvec3>& vertices = all.unique.vertices();
    if (vertices.size() > kMaxVertices)
        return Error{fmt::format("{}: found {} vertices, expected at most {} in a PLY file",
                                 path.string(), vertices.size(), kMaxVertices)};
    const bool as_floats =
        std::all_of(vertices.begin(), vertices.end(), [](const dvec3& v) { return is_float(v); });
    const char* type = as_floats ? "float" : "double";
    out->write(fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
                           "property {} x\nproperty {} y\nproperty {} z\nelement face {}\n"
                           "property list uchar int vertex_indices\nend_header\n",
                           vertices.size(), type, type, type, all.indices.size() / 3));
    for (const dvec3& v : vertices)
        write_position(*out, v, as_floats);
    for (size_t i = 0; i < all.indices.size(); i += 3) {
        const uint8_t corners = 3;
        out->write(&corners, 1);
        out->write(&all.indices[i], 3 * sizeof(uint32_t));
    }
    return out->commit();
}

Result<Done> write_obj(const Scene& scene, const std::filesystem::path& path) {
    Result<OutputFile> out = OutputFile::create(path);
    if (!out)
        return out.error();
    assert(scene.meshes.size() == scene.soup.chunks.size()); // every chunk has a name
    uint64_t vertices_above = 0;
    for (size_t m = 0; m < scene.soup.chunks.size(); ++m) {
        const std::string& name = scene.meshes[m].name;
        write_mesh(*out, name.empty() ? fmt::format("mesh{}", m) : name, scene.soup.chunks[m],
                   vertices_above);
    }
    return out->commit();
}

} // namespace ovc
