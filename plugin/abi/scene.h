// SPDX-License-Identifier: Apache-2.0
// The table's functions on scenes.
#pragma once

#include "plugin/overcast.h"

namespace ovc {

ovc_result create_scene(ovc_device device, const ovc_scene_config* config, ovc_scene* scene);
ovc_result add_mesh(ovc_scene scene, const ovc_mesh* mesh, uint32_t* mesh_id);
ovc_result add_instance(ovc_scene scene, const ovc_instance* instance, uint32_t* mesh_id);
ovc_result update_mesh(ovc_scene scene, uint32_t mesh_id, const ovc_mesh* mesh,
                       uint64_t first_triangle);
ovc_result update_instance(ovc_scene scene, uint32_t mesh_id, const double* transform);
ovc_result remove_mesh(ovc_scene scene, uint32_t mesh_id);
ovc_result commit(ovc_scene scene);
ovc_result statistics(ovc_scene scene, ovc_statistics* statistics);
ovc_result plan(ovc_scene scene, ovc_plan* plan);
ovc_result active(ovc_scene scene, ovc_active* active);
ovc_result save(ovc_scene scene, ovc_write_function write, void* user);
ovc_result purge(ovc_scene scene);
ovc_result save_streamed(ovc_device device, const ovc_scene_config* config,
                         const ovc_streamed_scene* scene);
ovc_result plan_streamed(ovc_device device, const ovc_scene_config* config,
                         const ovc_streamed_scene* scene, ovc_plan* plan);
void destroy_scene(ovc_scene scene);

} // namespace ovc
