/// One file that all ranks write, each at offsets of its own.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

namespace aeroloom::parallel {

/// A file that write_shared_file has opened.
class SharedFile {
public:
  struct Handle;
  explicit SharedFile(Handle& handle) : _handle(handle) {}
  /// Writes at `offset` bytes from the beginning; above 2^31 bytes too. Not collective. Throws
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

/// When a file has its name: once its bytes are on the disk (MPI_File_sync), so that a full one or a lost
/// server is an error, not a file that looks finished; or once the system has them, for files whose readers
/// can tell whether they are whole.
enum class Named : bool { when_on_disk, when_written };

/// Creates PATH.unfinished, and its folder where there is none, has every rank write what it has by `work`,
/// and gives the file its name when all have succeeded. `work` calls no collectives.
/// Until then what stood at PATH stays; a link at PATH.unfinished is not followed. Collective; throws
/// CollectiveError (files) on all ranks and removes the unfinished file where anything fails.
void write_shared_file(const Communicator& communicator, const std::string& path,
                       const std::function<void(SharedFile&)>& work, Named named = Named::when_on_disk);

}  // namespace aeroloom::parallel
