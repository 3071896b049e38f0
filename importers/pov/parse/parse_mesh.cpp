// SPDX-License-Identifier: Apache-2.0
// Reads mesh and mesh2. The triangles of each texture become a child of the object.
#include "importers/pov/parse/blended_texture.h"
#include "importers/pov/parse/parse_object.h"
#include "importers/pov/parse/texture.h"
#include "importers/pov/shapes/shape.h"
#include "importers/pov/words/block.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <map>

namespace ovc::pov {

namespace {

/// Triangles by texture. The textures are in the order of their first use.
class Groups {
public:
    Facets& of(const std::optional<Texture>& texture) {
        const auto same = [&](const Group& g) {
            return g.texture.has_value() == texture.has_value() &&
                   (!texture || same_look(*g.texture, *texture));
        };
        // Most triangles have the texture of the one before.
        if (!groups_.empty() && same(groups_[last_]))
            return groups_[last_].facets;
        const auto at = std::find_if(groups_.begin(), groups_.end(), same);
        last_ = size_t(at - groups_.begin());
        if (at == groups_.end())
            groups_.push_back({texture, {}});
        assert(last_ < groups_.size());
        return groups_[last_].facets;
    }

    void give_to(Object& object) {
        object.has_inside = false; // an inside_vector that follows sets it
        const bool faces_inside = volume() < 0;
        for (Group& group : groups_) {
            auto child = std::make_shared<Object>();
            child->kind = object.kind;
            child->place = object.place;
            child->faces_inside = faces_inside;
            child->texture = std::move(group.texture);
            Shape shape;
            shape.fixed = double(group.facets.corners.size() / 3);
            shape.cut = [facets = std::move(group.facets)](int, bool, Facets& out) {
                out.corners.insert(out.corners.end(), facets.corners.begin(), facets.corners.end());
                out.uv.insert(out.uv.end(), facets.uv.begin(), facets.uv.end());
                out.smooth = out.smooth || facets.smooth;
            };
            child->shape = std::move(shape);
            object.children.push_back(std::move(child));
        }
    }

private:
    /// Returns the volume within all triangles, by a sixth; negative where they face inside.
    double volume() const {
        double sum = 0;
        std::optional<dvec3> origin;
        for (const Group& group : groups_) {
            const std::vector<Corner>& c = group.facets.corners;
            for (size_t i = 0; i + 2 < c.size(); i += 3) {
                origin = origin.value_or(c[i].position);
                sum += glm::dot(c[i].position - *origin, glm::cross(c[i + 1].position - *origin,
                                                                    c[i + 2].position - *origin));
            }
        }
        return sum;
    }

    struct Group {
        std::optional<Texture> texture;
        Facets facets;
    };
    std::vector<Group> groups_;
    size_t last_ = 0;
};

using TriangleUv = std::array<vec2, 3>;

/// Returns whether povray draws a mesh's triangle with these normals as a flat one: they are equal.
bool is_flat(const Corner (&c)[3]) {
    const dvec3 first = glm::normalize(c[0].normal);
    const auto is_same = [&](const dvec3& normal) {
        const dvec3 off = glm::normalize(normal) - first;
        return glm::dot(off, off) <= 1e-10;
    };
    return is_same(c[1].normal) && is_same(c[2].normal);
}

void add_triangle(const Corner (&c)[3], bool smooth, const TriangleUv& uv, Facets& facets) {
    const bool added = smooth && !is_flat(c)
                           ? facets.add(c[0], c[1], c[2])
                           : facets.add(c[0].position, c[1].position, c[2].position);
    // Coordinates are kept from the first that is not 0 on.
    const bool is_zero = uv[0] == vec2(0) && uv[1] == vec2(0) && uv[2] == vec2(0);
    if (!added || (is_zero && facets.uv.empty()))
        return;
    facets.uv.resize(facets.corners.size() - 3, vec2(0));
    facets.uv.insert(facets.uv.end(), uv.begin(), uv.end());
}

/// The textures of triangles whose corners have several.
class CornerTextures {
public:
    /// Returns the texture of a triangle whose corners have these, and sets `uv` to what it is
    /// blended by. Textures on texture coordinates have no room for that: the first corner's is
    /// taken.
    Texture of(const std::vector<Texture>& all, const std::array<int, 3>& numbers, TriangleUv& uv) {
        const auto texture = [&](size_t i) { return all[size_t(numbers[i])]; };
        if (numbers[0] == numbers[1] && numbers[1] == numbers[2])
            return texture(0);
        for (size_t i = 0; i < 3; ++i)
            if (texture(i).pigment.uv_mapping)
                return texture(0);
        uv = {vec2(0), vec2(1, 0), vec2(0, 1)};
        const auto known = known_.find(numbers);
        if (known != known_.end())
            return known->second;
        std::vector<WeightedTexture> parts;
        for (size_t i = 0; i < 3; ++i)
            parts.push_back({texture(i), weight_of(i)});
        return known_[numbers] = *blended(parts, /* on_corners= */ true);
    }

private:
    /// Returns the formula of a corner's weight: u, v and what is missing to 1.
    static ProgramPtr weight_of(size_t corner) {
        ProgramBuilder weight;
        if (corner > 0)
            weight.add(FormulaStep::Kind::Argument, uint32_t(corner - 1));
        else {
            weight.constant(1);
            for (uint32_t other = 0; other < 2; ++other) {
                weight.add(FormulaStep::Kind::Argument, other);
                weight.add(FormulaStep::Kind::Subtract);
            }
            weight.constant(0);
            weight.add(FormulaStep::Kind::Builtin, builtin("max"), 2);
        }
        return weight.take();
    }

    std::map<std::array<int, 3>, Texture> known_;
};

/// Reads textures up to the } of their list. of: what it is a list of, for messages.
std::vector<Texture> parse_textures_of(Reader& reader, const char* of) {
    std::vector<Texture> textures;
    while (!reader.take('}'))
        if (reader.take("texture"))
            textures.push_back(parse_texture(reader));
        else if (const auto texture = take_named_if<Texture>(reader))
            textures.push_back(*texture);
        else if (!reader.take(','))
            reader.fail_here(fmt::format("'}}' or a texture of {}", of));
    return textures;
}

/// Reads the textures of a triangle's corners, `{ NAME NAME NAME }`.
std::vector<Texture> parse_corner_textures(Reader& reader) {
    const Place at = reader.peek().place;
    reader.expect('{', "texture_list");
    std::vector<Texture> textures = parse_textures_of(reader, "a triangle's corner");
    if (textures.size() != 3)
        reader.fail(at, fmt::format("found {} textures of a triangle's corners, expected 3",
                                    textures.size()));
    return textures;
}

/// Reads the `{ a, na, b, nb, c, nc texture { … } }` of a mesh's triangle.
void parse_mesh_triangle(Reader& reader, bool smooth, Groups& groups) {
    reader.expect('{', "triangle");
    Corner c[3];
    for (Corner& corner : c) {
        corner = {parse_vector(reader), dvec3(0)};
        reader.take_comma();
        if (smooth) {
            corner.normal = parse_vector(reader);
            reader.take_comma();
        }
    }
    std::optional<Texture> texture;
    TriangleUv uv{};
    while (!reader.take('}')) {
        if (reader.take("texture"))
            texture = parse_texture(reader);
        else if (reader.take("uv_vectors"))
            for (vec2& at : uv) {
                at = vec2(parse_vector2(reader));
                reader.take_comma();
            }
        else if (reader.take("texture_list"))
            texture = CornerTextures().of(parse_corner_textures(reader), {0, 1, 2}, uv);
        else
            reader.fail_here("'}' or a texture of a triangle");
    }
    reader.grow(3 * sizeof(Corner));
    add_triangle(c, smooth, uv, groups.of(texture));
}

std::vector<dvec3> parse_vectors(Reader& reader, std::string_view what) {
    reader.expect('{', what);
    const int count = parse_count(reader, 0);
    std::vector<dvec3> vectors;
    for (int i = 0; i < count; ++i) {
        reader.take_comma();
        vectors.push_back(parse_vector(reader));
    }
    reader.take_comma();
    reader.expect('}', what);
    return vectors;
}

struct Face {
    std::array<uint32_t, 3> corner{}, normal{}, uv{};
    std::array<int, 3> textures{-1, -1, -1}; // of the corners
};

std::array<uint32_t, 3> parse_indices(Reader& reader) {
    const Place at = reader.peek().place;
    const dvec3 v = parse_vector(reader);
    std::array<uint32_t, 3> indices;
    for (int i = 0; i < 3; ++i) {
        if (!(v[i] >= 0 && v[i] < 4e9))
            reader.fail(at, fmt::format("found the index {}, expected one from 0 on", v[i]));
        indices[size_t(i)] = uint32_t(v[i]);
    }
    return indices;
}

/// textures: whether faces name theirs, which they do where a texture_list came before. Else the
/// next face may be an expression that begins like a number.
std::vector<Face> parse_faces(Reader& reader, bool textures) {
    reader.expect('{', "face_indices");
    const int count = parse_count(reader, 0);
    std::vector<Face> faces;
    for (int i = 0; i < count; ++i) {
        reader.take_comma();
        Face face;
        face.corner = face.normal = face.uv = parse_indices(reader);
        for (int t = 0; textures && t < 3; ++t) {
            reader.take_comma();
            if (reader.peek().is('<') || reader.peek().is('}'))
                break;
            const int texture = parse_int(reader, 0, 1 << 30, "the number of a texture");
            std::fill(face.textures.begin() + t, face.textures.end(), texture);
        }
        faces.push_back(face);
    }
    reader.take_comma();
    reader.expect('}', "face_indices");
    return faces;
}

std::vector<Texture> parse_textures(Reader& reader) {
    reader.expect('{', "texture_list");
    parse_count(reader, 0);
    return parse_textures_of(reader, "the list");
}

struct Mesh2 {
    std::vector<dvec3> vertices, normals;
    std::vector<vec2> uv;
    std::vector<Face> faces;
    std::vector<Texture> textures;
};

/// Reads normal_indices or uv_indices, which come behind the faces.
void parse_more_indices(Reader& reader, std::string_view what,
                        std::array<uint32_t, 3> Face::*indices, Mesh2& mesh) {
    reader.expect('{', what);
    const int count =
        parse_int(reader, 0, int(mesh.faces.size()), fmt::format("the number of {}", what));
    for (int i = 0; i < count; ++i) {
        reader.take_comma();
        mesh.faces[size_t(i)].*indices = parse_indices(reader);
    }
    reader.take_comma();
    reader.expect('}', what);
}

/// Reads normals, of which those of no length are as in povray.
std::vector<dvec3> parse_normals(Reader& reader) {
    std::vector<dvec3> normals = parse_vectors(reader, "normal_vectors");
    std::replace(normals.begin(), normals.end(), dvec3(0), dvec3(1, 0, 0));
    return normals;
}

std::vector<vec2> parse_uv_vectors(Reader& reader) {
    reader.expect('{', "uv_vectors");
    const int count = parse_count(reader, 0);
    std::vector<vec2> uv;
    for (int i = 0; i < count; ++i) {
        reader.take_comma();
        uv.emplace_back(parse_vector2(reader));
    }
    reader.take_comma();
    reader.expect('}', "uv_vectors");
    return uv;
}

void add_faces(Reader& reader, const Mesh2& mesh, Groups& groups) {
    reader.grow(mesh.faces.size() * 3 * sizeof(Corner));
    CornerTextures of_corners;
    for (const Face& face : mesh.faces) {
        Corner c[3];
        bool smooth = !mesh.normals.empty();
        for (size_t i = 0; i < 3; ++i) {
            if (face.corner[i] >= mesh.vertices.size())
                reader.fail(reader.place(), fmt::format("found the index {} of {} vertices",
                                                        face.corner[i], mesh.vertices.size()));
            smooth = smooth && face.normal[i] < mesh.normals.size();
            c[i] = {mesh.vertices[face.corner[i]],
                    smooth ? mesh.normals[face.normal[i]] : dvec3(0)};
        }
        TriangleUv uv{};
        for (size_t i = 0; i < 3; ++i)
            uv[i] = face.uv[i] < mesh.uv.size() ? mesh.uv[face.uv[i]] : vec2(0);
        std::optional<Texture> texture;
        if (std::all_of(face.textures.begin(), face.textures.end(), [&](int number) {
                return number >= 0 && number < int(mesh.textures.size());
            }))
            texture = of_corners.of(mesh.textures, face.textures, uv);
        add_triangle(c, smooth, uv, groups.of(texture));
    }
}

} // namespace

void parse_mesh(Reader& reader, Object& object) {
    Groups groups;
    for (;;) {
        if (reader.take("triangle"))
            parse_mesh_triangle(reader, false, groups);
        else if (reader.take("smooth_triangle"))
            parse_mesh_triangle(reader, true, groups);
        else
            break;
    }
    groups.give_to(object);
    parse_modifiers(reader, object);
}

void parse_mesh2(Reader& reader, Object& object) {
    Mesh2 mesh;
    for (;;) {
        if (reader.take("vertex_vectors"))
            mesh.vertices = parse_vectors(reader, "vertex_vectors");
        else if (reader.take("normal_vectors"))
            mesh.normals = parse_normals(reader);
        else if (reader.take("uv_vectors"))
            mesh.uv = parse_uv_vectors(reader);
        else if (reader.take("uv_indices"))
            parse_more_indices(reader, "uv_indices", &Face::uv, mesh);
        else if (reader.take("texture_list"))
            mesh.textures = parse_textures(reader);
        else if (reader.take("face_indices"))
            mesh.faces = parse_faces(reader, !mesh.textures.empty());
        else if (reader.take("normal_indices"))
            parse_more_indices(reader, "normal_indices", &Face::normal, mesh);
        else
            break;
    }
    Groups groups;
    add_faces(reader, mesh, groups);
    groups.give_to(object);
    parse_modifiers(reader, object);
}

} // namespace ovc::pov
