// SPDX-License-Identifier: AGPL-3.0-or-later
// OvercastSettings: what the environment says of the way meshes go to Overcast.
#pragma once

#include <cstdint>
#include <string>

struct OvercastSettings {
    std::string library;           // OVC_PLUGIN; else libovercast.so, beside the program first
    std::string device;            // OVC_POVRAY_DEVICE: as `overcast devices` names it
    uint64_t gpu_memory_bytes = 0; // OVC_POVRAY_GPU_MEMORY: a mesh's, 256M. 0: what suits it
    long min_triangles = 10000;    // OVC_POVRAY_TRIANGLES: smaller meshes stay POV-Ray's
};

/// Throws std::runtime_error with one sentence for a variable that has no meaning.
OvercastSettings overcast_settings();
