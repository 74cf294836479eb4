/// p4est and the library under it, sc, while they work for us. Internal to forest/.
#pragma once

#include "parallel/communication/communicator.hpp"

namespace aeroloom::forest {

/// For the life of one call: p4est and sc are silent, and where they abort, all ranks end with one message
/// and the exit code of a program error, or of a lack of memory. A host program that has started either
/// before finds it as it was, and what it has set up stays in force; one that starts them later is the first
/// to do so: nothing of ours outlives the scope. Scopes do not nest.
class LibraryScope {
public:
  /// The rank and what is being done, a literal, are for the message.
  LibraryScope(parallel::Rank rank, const char* doing);
  ~LibraryScope();
  LibraryScope(const LibraryScope&) = delete;
  LibraryScope& operator=(const LibraryScope&) = delete;

  void now(const char* doing);

private:
  bool _registered_base = false, _registered_forest = false;
};

/// Ends all ranks for want of memory, in a callback of the library, where nothing can be agreed on.
[[noreturn]] void end_without_memory();

}  // namespace aeroloom::forest
