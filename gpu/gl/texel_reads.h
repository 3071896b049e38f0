// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace ovc {

/// How kernels read pages, portals and rays: by texelFetch, by imageLoad, or from storage buffers.
enum class TexelReads { Textures = 0, Images = 1, StorageBuffers = 2 };

} // namespace ovc
