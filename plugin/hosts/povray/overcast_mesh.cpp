// SPDX-License-Identifier: AGPL-3.0-or-later
#include "plugin/hosts/povray/overcast_mesh.h"

#include "plugin/hosts/povray/overcast_device.h"

#include <cstdint>
#include <cstdio>
#include <mutex>
#include <string>
#include <vector>

class OvercastMesh {
public:
    OvercastMesh(std::shared_ptr<OvercastDevice> device, const OvercastTriangles& triangles,
                 uint64_t gpu_memory_bytes)
        : device_(std::move(device)), count_(triangles.triangle_count) {
        ovc_scene_config config{};
        config.struct_size = sizeof config;
        config.gpu_memory_bytes = gpu_memory_bytes ? gpu_memory_bytes : device_->budget_for(count_);
        device_->check(device_->api().create_scene(device_->handle(), &config, &scene_));
        try {
            build(triangles);
        } catch (...) {
            device_->api().destroy_scene(scene_);
            throw;
        }
    }
    ~OvercastMesh() {
        ovc_statistics statistics{};
        statistics.struct_size = sizeof statistics;
        if (device_->api().statistics(scene_, &statistics) == OVC_OK)
            device_->count(count_, statistics.nearest_rays);
        device_->api().destroy_scene(scene_);
    }
    OvercastMesh(const OvercastMesh&) = delete;
    OvercastMesh& operator=(const OvercastMesh&) = delete;

    bool hit(const ovc_ray& ray, const OvercastHit* after, OvercastHit& hit) const {
        ovc_hit found, place{};
        ovc_query query{};
        query.struct_size = sizeof query;
        if (after) {
            place = {after->depth, 0, 0, 0, uint32_t(after->triangle)};
            query.after = &place;
        }
        device_->check(device_->api().intersect1(scene_, &ray, &found, &query));
        hit = {found.t, long(found.prim)};
        return found.mesh != OVC_NONE;
    }

private:
    void build(const OvercastTriangles& triangles) {
        const std::vector<uint32_t> corners = corners_of(triangles);
        ovc_mesh mesh{};
        mesh.struct_size = sizeof mesh;
        mesh.positions = &triangles.vertices[0][0];
        mesh.vertex_count = uint64_t(triangles.vertex_count);
        mesh.indices = corners.data();
        mesh.triangle_count = uint64_t(triangles.triangle_count);
        device_->check(device_->api().add_mesh(scene_, &mesh, nullptr));
        device_->check(device_->api().commit(scene_));
    }

    static std::vector<uint32_t> corners_of(const OvercastTriangles& triangles) {
        std::vector<uint32_t> corners;
        corners.reserve(size_t(triangles.triangle_count) * 3);
        const char* at = reinterpret_cast<const char*>(triangles.corners);
        for (long i = 0; i < triangles.triangle_count; ++i, at += triangles.corner_stride)
            for (int k = 0; k < 3; ++k)
                corners.push_back(uint32_t(reinterpret_cast<const long*>(at)[k]));
        return corners;
    }

    std::shared_ptr<OvercastDevice> device_;
    ovc_scene scene_ = nullptr;
    long count_;
};

/// Once, however many meshes it keeps from going to Overcast.
static void say_once(const std::string& sentence) {
    static std::mutex mutex;
    static std::string last;
    const std::lock_guard lock(mutex);
    if (sentence != last)
        std::fprintf(stderr, "\rpovray-overcast: %s; meshes stay POV-Ray's\n", sentence.c_str());
    last = sentence;
}

OvercastMesh* overcast_take(const OvercastTriangles& triangles) {
    const OvercastSettings settings = overcast_settings();
    if (triangles.triangle_count < settings.min_triangles)
        return nullptr;
    try {
        return new OvercastMesh(OvercastDevice::open(settings), triangles,
                                settings.gpu_memory_bytes);
    } catch (const OvercastFailure& failure) {
        say_once(failure.what());
        return nullptr;
    }
}

bool overcast_hit(const OvercastMesh& mesh, const double origin[3], const double direction[3],
                  double nearest, double farthest, const OvercastHit* after, OvercastHit& hit) {
    return mesh.hit({{origin[0], origin[1], origin[2]},
                     nearest,
                     {direction[0], direction[1], direction[2]},
                     farthest},
                    after, hit);
}

void overcast_release(OvercastMesh* mesh) {
    delete mesh;
}
