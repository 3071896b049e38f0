// SPDX-License-Identifier: Apache-2.0
// Preloaded into a program, makes MPI_Isend fail from the N-th of the calls that send more than a
// word on, in the rank of OVC_FAULT=RANK:N. Profiling libraries take the place of MPI's functions
// in the same way.
#include <mpi.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

static atomic_int calls;

int MPI_Isend(const void* from, int count, MPI_Datatype type, int to, int tag,
              MPI_Comm communicator, MPI_Request* request) {
    int victim, n, rank;
    const char* fault = getenv("OVC_FAULT");
    PMPI_Comm_rank(MPI_COMM_WORLD, &rank);
    if (count > 4 && fault && sscanf(fault, "%d:%d", &victim, &n) == 2 && rank == victim &&
        atomic_fetch_add(&calls, 1) + 1 >= n)
        return MPI_ERR_OTHER;
    return PMPI_Isend(from, count, type, to, tag, communicator, request);
}
