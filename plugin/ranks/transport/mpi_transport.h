// SPDX-License-Identifier: Apache-2.0
// MpiTransport: the transport between the processes of an MPI communicator.
#pragma once

#include "plugin/ranks/transport/transport.h"

#include <memory>

namespace ovc {

struct MpiTransportOptions {
    int32_t communicator = 0;   // as MPI_Comm_c2f tells it; 0: MPI_COMM_WORLD
    double timeout_seconds = 0; // a rank that gives no word for so long is lost; 0: 60
    /// Whether the process may be ended, with a sentence, where MPI itself waits so long for a rank
    /// that hangs, as it starts or ends: nobody else can. It then holds for all transports.
    bool may_end_process = false;
};

/// Makes the transport; all ranks of the communicator call this, in the same order where there are
/// several transports. Starts MPI where the host has not. Error: MPI is not there for all threads,
/// or the communicator is none.
Result<std::unique_ptr<Transport>> make_mpi_transport(const MpiTransportOptions& options);

/// Ends all processes of the program at once, with this exit code.
[[noreturn]] void abort_all_ranks(int code);

} // namespace ovc
