// SPDX-License-Identifier: Apache-2.0
// Each order gives pixels the faces that it promises, and rays begin on them along their normals.
#include "host/camera/face_rays.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

/// Returns a mesh whose face i lies around (i, 0, 0) and looks along z.
FaceMesh row_of(int faces, double height) {
    FaceMesh mesh;
    for (int i = 0; i < faces; ++i)
        mesh.corners.push_back(
            {dvec3(i - 0.5, -0.25, height), dvec3(i + 0.5, -0.25, height), dvec3(i, 0.5, height)});
    return mesh;
}

/// Returns a square of two faces over all texture coordinates, at (u, v, 0).
FaceMesh square_of_uv() {
    FaceMesh mesh;
    mesh.corners = {{dvec3(0), dvec3(1, 0, 0), dvec3(1, 1, 0)},
                    {dvec3(0), dvec3(1, 1, 0), dvec3(0, 1, 0)}};
    mesh.uv = {{vec2(0), vec2(1, 0), vec2(1)}, {vec2(0), vec2(1), vec2(0, 1)}};
    return mesh;
}

bool is_at(const Ray& ray, const dvec3& at) {
    return glm::length(ray.org - at) < 1e-12 && ray.dir != dvec3(0);
}

constexpr dvec2 kMiddle{0.5};

TEST(FaceRays, GiveEachRayOfAPixelAMesh) {
    FaceCamera camera{FaceCamera::Order::EachMesh, {row_of(6, 0), row_of(5, 7)}, 0.25};
    const FaceRays rays(camera, {3, 2});
    EXPECT_TRUE(is_at(rays.ray(1, 1, kMiddle, 0), {4, 0, -0.25}));
    EXPECT_TRUE(is_at(rays.ray(1, 1, kMiddle, 1), {4, 0, 6.75}));
    EXPECT_EQ(rays.ray(2, 1, kMiddle, 0).dir, dvec3(0, 0, -1))
        << "the corners go round by the right hand, povray's normals by the left";
    EXPECT_EQ(rays.ray(2, 1, kMiddle, 1).dir, dvec3(0)) << "the second mesh has five faces";
    camera.backwards = true;
    EXPECT_EQ(rays.ray(2, 1, kMiddle, 0).dir, dvec3(0, 0, 1));
}

TEST(FaceRays, CountOnFromMeshToMesh) {
    const FaceCamera camera{FaceCamera::Order::OneAfterAnother, {row_of(5, 0), row_of(4, 7)}};
    const FaceRays rays(camera, {3, 2});
    EXPECT_TRUE(is_at(rays.ray(2, 1, kMiddle, 0), {0, 0, 7}));
    EXPECT_TRUE(is_at(rays.ray(2, 0, kMiddle, 1), {3, 0, 7}));
    EXPECT_EQ(rays.ray(0, 1, kMiddle, 1).dir, dvec3(0));
}

TEST(FaceRays, StandSideBySide) {
    const FaceCamera camera{FaceCamera::Order::SideBySide, {row_of(4, 0), row_of(4, 7)}};
    const FaceRays rays(camera, {4, 2});
    EXPECT_TRUE(is_at(rays.ray(1, 1, kMiddle, 0), {3, 0, 0}));
    EXPECT_TRUE(is_at(rays.ray(2, 1, kMiddle, 0), {2, 0, 7}));
}

TEST(FaceRays, BeginAtTheTextureCoordinatesOfThePixel) {
    FaceCamera camera{FaceCamera::Order::ByUv, {square_of_uv()}};
    const FaceRays rays(camera, {4, 2});
    EXPECT_TRUE(is_at(rays.ray(0, 0, kMiddle, 0), {0.125, 0.75, 0}));
    EXPECT_TRUE(is_at(rays.ray(3, 1, {0.25, 0.75}, 0), {0.8125, 0.125, 0}));
    camera.meshes[0].normals.assign(2, {vec3(1, 0, 0), vec3(1, 0, 0), vec3(1, 0, 0)});
    EXPECT_EQ(FaceRays(camera, {4, 2}).ray(0, 0, kMiddle, 0).dir, dvec3(1, 0, 0));
    camera.meshes[0].uv[0] = {vec2(NAN), vec2(0), vec2(1)};
    EXPECT_EQ(FaceRays(camera, {4, 2}).ray(3, 1, kMiddle, 0).dir, dvec3(0));
}

} // namespace
} // namespace ovc
