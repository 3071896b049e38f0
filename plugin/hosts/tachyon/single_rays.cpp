// SPDX-License-Identifier: Apache-2.0
// The C ABI, called for one set of triangles.
#include "plugin/hosts/tachyon/single_rays.h"

#include <cstdio>
#include <stdexcept>
#include <utility>

namespace ovc::tachyon {

static void say(void*, ovc_log_level level, const char* message) {
    if (level != OVC_LOG_INFO)
        std::fprintf(stderr, "overcast: %s\n", message);
}

/// NULL where they are of the other kind.
template <class Number>
static const Number* data_of(const Corners& corners) {
    const auto* numbers = std::get_if<std::vector<Number>>(&corners);
    return numbers ? numbers->data() : nullptr;
}

SingleRays::SingleRays(Corners corners, const Settings& settings)
    : corners_(std::move(corners)), api_(ovc_get_api(OVC_ABI_VERSION)) {
    if (!api_ || api_->struct_size < sizeof(ovc_api))
        throw std::runtime_error("libovercast.so is not of the version this was built for");
    ovc_device_config device{};
    device.struct_size = sizeof(device);
    device.name = settings.device.empty() ? nullptr : settings.device.c_str();
    device.log = say;
    check(api_->create_device(&device, &device_));
    try {
        ovc_scene_config config{};
        config.struct_size = sizeof(config);
        config.gpu_memory_bytes = settings.gpu_memory_bytes;
        check(api_->create_scene(device_, &config, &scene_));
        ovc_mesh mesh{};
        mesh.struct_size = sizeof(mesh);
        mesh.positions = data_of<float>(corners_);
        mesh.positions_double = data_of<double>(corners_);
        mesh.vertex_count = std::visit([](const auto& c) { return c.size(); }, corners_) / 3;
        mesh.flags = OVC_MESH_SHARED;
        check(api_->add_mesh(scene_, &mesh, nullptr));
        check(api_->commit(scene_));
    } catch (...) {
        api_->destroy_scene(scene_);
        api_->destroy_device(device_);
        throw;
    }
}

SingleRays::~SingleRays() {
    api_->destroy_scene(scene_);
    api_->destroy_device(device_);
}

void SingleRays::check(ovc_result result) const {
    if (result != OVC_OK)
        throw std::runtime_error(api_->last_error(device_));
}

std::optional<ovc_hit> SingleRays::nearest(const ovc_ray& ray, const ovc_hit& after,
                                           uint32_t skip) const {
    const ovc_triangle skipped{skip == OVC_NONE ? OVC_NONE : 0, skip};
    ovc_query query{};
    query.struct_size = sizeof(query);
    query.skip = &skipped;
    query.after = &after;
    ovc_hit hit;
    check(api_->intersect1(scene_, &ray, &hit, &query));
    return hit.prim == OVC_NONE ? std::nullopt : std::optional(hit);
}

ovc_statistics SingleRays::statistics() const {
    ovc_statistics statistics{};
    statistics.struct_size = sizeof(statistics);
    check(api_->statistics(scene_, &statistics));
    return statistics;
}

std::string SingleRays::renderer() const {
    ovc_device_info info{};
    info.struct_size = sizeof(info);
    check(api_->describe_device(device_, &info));
    return info.renderer;
}

} // namespace ovc::tachyon
