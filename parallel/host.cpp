#include "parallel/host.hpp"

#include "parallel/session.hpp"

#include <stdexcept>

namespace aeroloom::parallel {

Communicator communicator_of(MPI_Comm host) {
  if (!session::is_library_running()) throw std::logic_error("communicator_of: MPI is not running");
  if (host == MPI_COMM_NULL) throw std::logic_error("communicator_of: no communicator");
  return Communicator(session::duplicate(host));
}

}  // namespace aeroloom::parallel
