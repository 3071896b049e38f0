// SPDX-License-Identifier: Apache-2.0
// Reads mesh_camera { RAYS, DISTRIBUTION MESH … [smooth] }.
// Based on: the README of POV-Ray 3.7's sample scenes of mesh_camera.
#include "importers/pov/object.h"
#include "importers/pov/parse/parse_camera.h"
#include "importers/pov/parse/parse_object.h"

namespace ovc::pov {

namespace {

std::array<vec3, 3> normals_of(const Corner* corners, const dmat3& turned, const dvec3& flat) {
    std::array<vec3, 3> normals;
    for (size_t i = 0; i < 3; ++i) {
        const dvec3 n = corners[i].normal == dvec3(0) ? flat : turned * corners[i].normal;
        normals[i] = vec3(glm::normalize(n));
    }
    return normals;
}

/// Adds the faces of a mesh's parts. smooth: with the normals of their corners.
void add_faces(const Object& object, const dmat4& placed, bool smooth, FaceMesh& mesh) {
    const dmat4 to_world = placed * object.placed;
    const dmat3 turned = glm::transpose(glm::inverse(dmat3(to_world)));
    if (const auto* shape = std::get_if<Shape>(&object.shape)) {
        Facets facets;
        shape->cut(/* segments= */ 8, /* open= */ false, facets);
        for (size_t t = 0; t + 2 < facets.corners.size(); t += 3) {
            std::array<dvec3, 3> corners;
            for (size_t i = 0; i < 3; ++i)
                corners[i] = dvec3(to_world * dvec4(facets.corners[t + i].position, 1));
            mesh.corners.push_back(corners);
            if (smooth)
                mesh.normals.push_back(
                    normals_of(&facets.corners[t], turned,
                               glm::cross(corners[2] - corners[0], corners[1] - corners[0])));
            const bool has_uv = !facets.uv.empty();
            mesh.uv.push_back({has_uv ? facets.uv[t] : vec2(0), has_uv ? facets.uv[t + 1] : vec2(0),
                               has_uv ? facets.uv[t + 2] : vec2(0)});
        }
    }
    for (const ObjectPtr& child : object.children)
        add_faces(*child, to_world, smooth, mesh);
}

} // namespace

void parse_mesh_camera(Reader& reader, CameraValue& camera) {
    reader.expect('{', "mesh_camera");
    camera.face_rays = uint32_t(parse_int(reader, 1, 1 << 16, "the rays of a mesh_camera"));
    reader.take_comma();
    auto faces = std::make_shared<FaceCamera>();
    faces->order = FaceCamera::Order(parse_int(reader, 0, 3, "the distribution of a mesh_camera"));
    reader.take_comma();
    std::vector<ObjectPtr> meshes;
    bool smooth = false;
    while (!reader.take('}')) {
        if (starts_object(reader.peek()))
            meshes.push_back(parse_object(reader));
        else if (const auto object = take_named_if<ObjectPtr>(reader))
            meshes.push_back(*object);
        else if (reader.take("smooth"))
            smooth = parse_flag(reader);
        else if (!reader.take(','))
            reader.fail_here("'}' or a mesh of a mesh_camera");
    }
    if (meshes.empty())
        reader.fail(reader.place(), "found a mesh_camera without a mesh");
    for (const ObjectPtr& object : meshes) {
        FaceMesh mesh;
        add_faces(*object, dmat4(1), smooth, mesh);
        if (faces->order != FaceCamera::Order::ByUv)
            mesh.uv = {};
        reader.grow(mesh.corners.size() * (sizeof(mesh.corners[0]) + (smooth ? 36 : 0)));
        faces->meshes.push_back(std::move(mesh));
    }
    camera.faces = std::move(faces);
}

} // namespace ovc::pov
