/// One file that all ranks write, each at its own offsets.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

namespace aeroloom::parallel {

/// A file opened by write_shared_file().
class SharedFile {
public:
  struct Handle;
  explicit SharedFile(Handle& handle) : _handle(handle) {}
  /// Writes the bytes, any number of them, at `offset` from the beginning. Not collective. Throws
  /// std::filesystem::filesystem_error with the reason.
  void write(std::int64_t offset, std::span<const std::byte> bytes);
  template <Flat T>
  void write_items(std::int64_t offset, std::span<const T> items) {
    static_assert(is_exact<T>);
    write(offset, std::as_bytes(items));
  }

private:
  Handle& _handle;
};

/// When a file gets its name. `when_on_disk`: after MPI_File_sync, so that a full disk or a lost server is an
/// error, not a file that looks complete. `when_written`: once the system has the bytes, for files whose
/// readers check that they are complete.
enum class Named : bool { when_on_disk, when_written };

/// Creates PATH.unfinished, and its folder if missing, and calls `work` on every rank to write it. Renames it
/// to PATH when all ranks have succeeded; until then an older file at PATH stays. `work` calls no
/// collectives. A link at PATH.unfinished is not followed. On any failure the unfinished file is removed and
/// all ranks throw CollectiveError (files). Collective.
void write_shared_file(const Communicator& communicator, const std::string& path,
                       const std::function<void(SharedFile&)>& work, Named named = Named::when_on_disk);

}  // namespace aeroloom::parallel
