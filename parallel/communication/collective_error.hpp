/// Errors that all ranks learn of together.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <functional>
#include <stdexcept>
#include <string>

namespace aeroloom::parallel {

/// The cause that an exception tells of: bad_alloc is `resources`, logic_error is `bug`, a failure of
/// reading or writing files (std::ios_base::failure, filesystem_error) is `files`, anything else `input`.
enum class FailureKind { input, files, resources, bug };

/// Thrown on every rank with the same text and kind: those of the lowest rank that failed, with a count of
/// the other failing ranks appended where there are any.
class CollectiveError : public std::runtime_error {
public:
  CollectiveError(FailureKind kind, const std::string& message) : std::runtime_error(message), _kind(kind) {}
  FailureKind kind() const { return _kind; }

private:
  FailureKind _kind;
};

/// Runs `work` on every rank, then agrees: if it threw anywhere, every rank throws the same CollectiveError.
/// Collective. `work` must not itself call collectives that a failing rank would not reach; a CollectiveError
/// thrown inside (by a nested collective) passes through unchanged, because all ranks have it already.
void agree(const Communicator& communicator, const std::function<void()>& work);
/// As agree(), of work that rank 0 alone does.
void on_root(const Communicator& communicator, const std::function<void()>& work);
/// Whether this rank is at the work of an agree(): what it throws now, all will learn of.
bool is_agreeing();

}  // namespace aeroloom::parallel
