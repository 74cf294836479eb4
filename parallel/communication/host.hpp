/// For programs that run MPI themselves and use the stages as a library. Includes mpi.h; no other public
/// header does.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <mpi.h>

namespace aeroloom::parallel {

/// The ranks of a communicator of the host program, which has started MPI. It is duplicated, so messages of
/// the two never mix; the duplicate is freed with the last copy of the result, which all ranks let go at the
/// same point, or by the end of MPI. Collective over `host`. Throws std::logic_error where MPI is not running
/// or `host` is no communicator.
Communicator communicator_of(MPI_Comm host);

/// The other way round, for libraries that take a communicator. It stays ours and lives as long as
/// `communicator` does; messages on it must not be under way when the library returns. Not collective.
MPI_Comm host_communicator(const Communicator& communicator);

}  // namespace aeroloom::parallel
