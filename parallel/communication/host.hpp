/// Communicators of host programs, which run MPI themselves and use the stages as a library. The only public
/// header that includes mpi.h.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <mpi.h>

namespace aeroloom::parallel {

/// Duplicates a communicator of the host program, so that messages of the two never mix. The duplicate is
/// freed with the last copy of the result, or when MPI ends; all ranks must free it at the same point.
/// Collective over `host`. Throws std::logic_error if MPI is not running or `host` is no communicator.
Communicator communicator_of(MPI_Comm host);

/// The MPI handle, for libraries that take one. It is valid as long as `communicator` lives. The library must
/// complete all messages on it before it returns. Not collective.
MPI_Comm host_communicator(const Communicator& communicator);

}  // namespace aeroloom::parallel
