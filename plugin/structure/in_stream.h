// SPDX-License-Identifier: Apache-2.0
// Marks threads that are inside a stream.
#pragma once

namespace ovc {

/// Whether this thread is inside stream(). It has the scene's turn and a use of the device's budget
/// then, so it asks for no answer together with others: the thread that traces for all of them may
/// wait for either. It is trivial, as all that is thread_local here must be.
inline constinit thread_local bool in_stream = false;

} // namespace ovc
