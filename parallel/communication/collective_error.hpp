/// Errors that every rank throws together, so that no rank waits for one that has failed.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <functional>
#include <stdexcept>
#include <string>

namespace aeroloom::parallel {

/// The cause of a failure, by the type of the exception: bad_alloc is `resources`, logic_error is `bug`.
/// std::ios_base::failure and filesystem_error are `files`. Any other exception is `input`.
enum class FailureKind { input, files, resources, bug };

/// Thrown on every rank with the same text and kind. They are those of the lowest rank that failed; the text
/// ends with the number of other failed ranks.
class CollectiveError : public std::runtime_error {
public:
  CollectiveError(FailureKind kind, const std::string& message) : std::runtime_error(message), _kind(kind) {}
  FailureKind kind() const { return _kind; }

private:
  FailureKind _kind;
};

/// Runs `work` on every rank. Then the ranks agree (as MPIX_Comm_agree does) whether it failed anywhere; if
/// so, every rank throws the same CollectiveError. Collective. `work` must not call collectives that a
/// failing rank would not reach. A CollectiveError thrown inside it passes unchanged: all ranks have it
/// already.
void agree(const Communicator& communicator, const std::function<void()>& work);
/// As agree(), but only rank 0 does the work.
void on_root(const Communicator& communicator, const std::function<void()>& work);
/// Whether this rank is inside agree(): an exception thrown now reaches all ranks.
bool is_agreeing();

}  // namespace aeroloom::parallel
