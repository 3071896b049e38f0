// SPDX-License-Identifier: Apache-2.0
// The table of shapes, and those whose triangles the file holds itself.
#include "importers/pbrt/shapes/shapes.h"

#include "importers/file/text.h"
#include "importers/readers.h"

#include <fmt/format.h>

#include <cassert>

namespace ovc::pbrt {

namespace {

struct Maker {
    std::string_view type;
    std::optional<Mesh> (*make)(ShapeRequest&);
};

constexpr Maker kMakers[] = {{"trianglemesh", make_triangle_mesh},
                             {"plymesh", make_ply_mesh},
                             {"heightfield", make_height_field},
                             {"bilinearmesh", make_bilinear_mesh},
                             {"loopsubdiv", make_loop_subdivision},
                             {"sphere", make_quadric},
                             {"disk", make_quadric},
                             {"cylinder", make_quadric},
                             {"cone", make_quadric},
                             {"paraboloid", make_quadric},
                             {"hyperboloid", make_quadric}};

/// Notes in the mesh the data of its vertices that it has no use for.
std::optional<Mesh> told(std::optional<Mesh> mesh, const ShapeRequest& request) {
    const Parameters& parameters = request.parameters;
    if (mesh && mesh->normals.empty() && parameters.find("N"))
        mesh->normals_left_out = 3 * mesh->size();
    if (mesh && !request.wants_uv && (parameters.find("uv") || parameters.find("st")))
        mesh->texture_coordinates_left_out = 3 * mesh->size();
    return mesh;
}

} // namespace

std::nullopt_t left_out(ShapeRequest& request, std::string_view why) {
    request.diagnostics.missing(fmt::format("shape {} {}", request.type, why), request.place,
                                fmt::format("a shape '{}' left out: {}", request.type, why));
    return std::nullopt;
}

std::optional<Mesh> make_shape(ShapeRequest& request) {
    for (const Maker& maker : kMakers)
        if (maker.type == request.type)
            return told(maker.make(request), request);
    const std::string type(request.type);
    request.diagnostics.missing("shape " + type, request.place,
                                fmt::format("shapes {} left out", ovc::quoted(type)));
    return std::nullopt;
}

std::vector<double> take_points(ShapeRequest& request) {
    std::vector<double> points =
        request.parameters.take("P", {Kind::Point3, Kind::Vector3, Kind::Float});
    if (!points.empty() && points.size() % 3 == 0)
        return points;
    left_out(request, points.empty() ? "it has no points P" : "its points P are not in triples");
    return {};
}

std::vector<vec2> take_uv(ShapeRequest& request, size_t vertices) {
    if (!request.wants_uv)
        return {};
    std::span<const double> numbers;
    for (const char* name : {"uv", "st"})
        if (numbers.empty())
            numbers = request.parameters.numbers(name, {Kind::Point2, Kind::Vector2, Kind::Float});
    if (numbers.size() != 2 * vertices) {
        if (!numbers.empty())
            request.diagnostics.missing("uv of " + std::string(request.type), request.place,
                                        fmt::format("uv left out: found {} numbers for {}",
                                                    numbers.size(), counted(vertices, "point")));
        return {};
    }
    std::vector<vec2> uv(vertices);
    for (size_t i = 0; i < vertices; ++i)
        uv[i] = vec2(float(numbers[2 * i]), float(numbers[2 * i + 1]));
    return uv;
}

std::vector<vec3> take_normals(ShapeRequest& request, size_t vertices) {
    const std::vector<double> numbers =
        request.parameters.take("N", {Kind::Normal, Kind::Vector3, Kind::Point3});
    if (numbers.size() != 3 * vertices) {
        if (!numbers.empty())
            request.diagnostics.missing("normals of " + std::string(request.type), request.place,
                                        fmt::format("normals left out: found {} numbers for {}",
                                                    numbers.size(), counted(vertices, "point")));
        return {};
    }
    std::vector<vec3> normals(vertices);
    for (size_t i = 0; i < vertices; ++i)
        normals[i] =
            vec3(float(numbers[3 * i]), float(numbers[3 * i + 1]), float(numbers[3 * i + 2]));
    return normals;
}

std::optional<std::vector<uint32_t>> take_indices(ShapeRequest& request, size_t vertices,
                                                  size_t group) {
    assert(vertices > 0 && group > 0);
    std::vector<double> numbers = request.parameters.take("indices", {Kind::Integer});
    if (numbers.size() % group != 0)
        return left_out(request, fmt::format("its indices do not come in groups of {}", group));
    std::vector<uint32_t> indices(numbers.size());
    for (size_t i = 0; i < numbers.size(); ++i) {
        if (!(numbers[i] >= 0 && numbers[i] < double(vertices)))
            return left_out(request, fmt::format("found vertex index {}, expected 0 to {}",
                                                 numbers[i], vertices - 1));
        indices[i] = uint32_t(numbers[i]);
    }
    return indices;
}

std::optional<Mesh> make_triangle_mesh(ShapeRequest& request) {
    Mesh mesh;
    mesh.positions = take_points(request);
    if (mesh.positions.empty())
        return std::nullopt;
    const size_t vertices = mesh.positions.size() / 3;
    auto indices = take_indices(request, vertices, 3);
    if (!indices)
        return std::nullopt;
    // In v4, one triangle needs no indices.
    if (indices->empty() && vertices == 3)
        *indices = {0, 1, 2};
    if (indices->empty())
        return left_out(request, "it has no indices");
    mesh.indices = std::move(*indices);
    mesh.normals = take_normals(request, vertices);
    mesh.uv = take_uv(request, vertices);
    return mesh;
}

/// Whether the triangles of a PLY file, which may be compressed, might take more than a quarter of
/// the memory that reading may take.
static bool is_large(const std::filesystem::path& path, const Streaming& streaming) {
    constexpr uint64_t kMemoryPerByte = 16;
    std::error_code ec;
    const uint64_t bytes = std::filesystem::file_size(path, ec);
    return !ec && bytes > streaming.host_bytes / 4 / kMemoryPerByte;
}

/// Takes the triangles of a PLY file.
struct Waiting {
    std::shared_ptr<TriangleStore> store;
    Streaming streaming;

    /// Its vertices may take as much memory as a shape.
    static Result<Waiting> create(const Streaming& whole) {
        Result<TriangleStore> made = TriangleStore::create(whole.folder);
        if (!made)
            return made.error();
        auto store = std::make_shared<TriangleStore>(std::move(*made));
        const Streaming streaming{*store, whole.host_bytes / 4, whole.folder};
        return Waiting{std::move(store), streaming};
    }
};

std::optional<Mesh> make_ply_mesh(ShapeRequest& request) {
    const std::string name = request.parameters.text("filename");
    const auto path = request.tokens.find(name);
    if (!path) {
        request.diagnostics.missing("file " + name, request.place, request.tokens.no_file(name));
        return std::nullopt;
    }
    ImportOptions options;
    options.log = request.diagnostics.log();
    options.files = request.tokens.files_read();
    options.texture_coordinates = request.wants_uv;
    Mesh mesh;
    std::optional<Waiting> waiting;
    if (request.streaming && is_large(*path, *request.streaming)) {
        Result<Waiting> made = Waiting::create(*request.streaming);
        if (!made) {
            request.diagnostics.fail(made.error());
            return std::nullopt;
        }
        waiting.emplace(std::move(*made));
        options.streaming = &waiting->streaming;
    }
    Result<Scene> scene = read_ply(*path, options);
    if (waiting) {
        if (const Result<Done> stored = waiting->store->finish(); !stored) {
            request.diagnostics.fail(stored.error());
            return std::nullopt;
        }
        mesh.on_disk = waiting->store;
    }
    if (!scene) {
        request.diagnostics.missing("file " + name, request.place,
                                    fmt::format("a plymesh left out: {}", scene.error().message));
        return std::nullopt;
    }
    mesh.name = path->stem().string();
    assert(scene->soup.chunks.size() == 1 && scene->meshes.size() == 1);
    Chunk& chunk = scene->soup.chunks[0];
    mesh.origin = chunk.origin();
    mesh.corners = chunk.take_corners();
    MeshInfo& info = scene->meshes[0];
    mesh.normals = std::move(info.normals);
    mesh.uv = std::move(info.uv);
    mesh.normals_left_out = info.normals_left_out;
    mesh.texture_coordinates_left_out = info.texture_coordinates_left_out;
    return mesh;
}

/// The field lies over the unit square with x along a row; its heights are z.
std::optional<Mesh> make_height_field(ShapeRequest& request) {
    const double across = request.parameters.number("nu", 0);
    const double down = request.parameters.number("nv", 0);
    const std::vector<double> heights = request.parameters.take("Pz", {Kind::Float, Kind::Integer});
    if (!(across >= 2 && down >= 2 && across * down == double(heights.size())) ||
        across != std::floor(across) || down != std::floor(down))
        return left_out(request, fmt::format("found {} heights Pz for nu {} and nv {}",
                                             heights.size(), across, down));
    const auto nu = size_t(across), nv = size_t(down);
    Mesh mesh;
    mesh.positions.reserve(heights.size() * 3);
    mesh.indices.reserve((nu - 1) * (nv - 1) * 6);
    for (size_t v = 0; v < nv; ++v)
        for (size_t u = 0; u < nu; ++u) {
            const dvec2 at(double(u) / double(nu - 1), double(v) / double(nv - 1));
            mesh.add_vertex({at.x, at.y, heights[v * nu + u]});
            if (request.wants_uv)
                mesh.uv.emplace_back(at);
        }
    for (size_t v = 0; v + 1 < nv; ++v)
        for (size_t u = 0; u + 1 < nu; ++u) {
            const auto corner = uint32_t(v * nu + u);
            const auto above = uint32_t(corner + nu);
            mesh.add_triangle(corner, corner + 1, above + 1);
            mesh.add_triangle(corner, above + 1, above);
        }
    return mesh;
}

} // namespace ovc::pbrt
