#include "parallel/communication/host.hpp"

#include "parallel/communication/session.hpp"

#include <stdexcept>

namespace aeroloom::parallel {

Communicator communicator_of(MPI_Comm host) {
  if (!session::is_library_running()) throw std::logic_error("communicator_of: MPI is not running");
  if (host == MPI_COMM_NULL) throw std::logic_error("communicator_of: no communicator");
  return Communicator(session::duplicate(host));
}

/// May look into a communicator.
struct HostAccess {
  static MPI_Comm handle_of(const Communicator& communicator) {
    return communicator.usable_handle().communicator;
  }
};

MPI_Comm host_communicator(const Communicator& communicator) {
  return HostAccess::handle_of(communicator);
}

}  // namespace aeroloom::parallel
