// SPDX-License-Identifier: Apache-2.0
// Calls whose rays are shared out between ranks: the first one makes them, the others serve.
#pragma once

#include "host/backend/backend.h"
#include "host/ranks/ranks.h"

#include <memory>
#include <span>

namespace ovc {

/// Returns a backend for rank 0, whose calls every rank answers a part of. backend: that of this
/// rank. number: of the backend among those that serve_calls() has on the other ranks. A call with
/// rays that an earlier one had does not send them again. It knows neither places to go on behind
/// nor sieves.
std::unique_ptr<Backend> make_shared_backend(const Ranks& ranks, std::unique_ptr<Backend> backend,
                                             uint32_t number);

/// Answers this rank's part of the calls of rank 0, until end_calls(). Error: a rank is lost, or a
/// backend fails.
Result<Done> serve_calls(const Ranks& ranks, std::span<const std::unique_ptr<Backend>> backends);

/// Ends serve_calls() on the other ranks.
Result<Done> end_calls(const Ranks& ranks);

} // namespace ovc
