/// The state of p4est and of sc, the library below it, during a call. Internal to the namespace forest.
#pragma once

#include "parallel/communication/communicator.hpp"

namespace aeroloom::forest {

/// While a scope lives, p4est and sc print nothing. If they abort, all ranks end with one message and the
/// exit code of a program error or of a lack of memory. If the host program has initialised them before, its
/// settings stay in force. If not, the scope initialises them, and its destructor undoes that. Scopes do not
/// nest.
class LibraryScope {
public:
  /// `doing` is a literal. Both stand in the message.
  LibraryScope(parallel::Rank rank, const char* doing);
  ~LibraryScope();
  LibraryScope(const LibraryScope&) = delete;
  LibraryScope& operator=(const LibraryScope&) = delete;

  /// The next step, for the message.
  void now(const char* doing);

private:
  bool _registered_base = false, _registered_forest = false;
};

/// Ends all ranks for lack of memory. For callbacks of p4est, where no collective error can be thrown.
[[noreturn]] void end_without_memory();

}  // namespace aeroloom::forest
