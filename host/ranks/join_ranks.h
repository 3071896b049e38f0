// SPDX-License-Identifier: Apache-2.0
// join_ranks(): makes a command's process one of several, where mpirun has started them.
#pragma once

#include "host/backend/backend.h"
#include "host/ranks/ranks.h"
#include "host/scene/scene_source.h"

#include <string_view>

namespace ovc {

/// Opens the ranks of the command, if there are any, and fits the options to them: the backend is
/// two-level, and of a scene file that is shared out, each rank reads no more than its share. Other
/// ranks than the first say nothing on an interrupt. Error: a backend whose work cannot be shared,
/// or no MPI.
Result<Done> join_ranks(std::string_view command, BackendOptions& backend, SceneArguments& scene);

} // namespace ovc
