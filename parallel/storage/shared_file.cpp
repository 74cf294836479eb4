#include "parallel/storage/shared_file.hpp"

#include "parallel/communication/collective_error.hpp"
#include "parallel/communication/host.hpp"
#include "parallel/communication/session.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>

namespace aeroloom::parallel {

namespace fs = std::filesystem;

struct SharedFile::Handle {
  std::string path;
  MPI_File file = MPI_FILE_NULL;
};

namespace {

/// Counts of the library are 32-bit.
constexpr std::size_t largest_transfer = std::size_t{1} << 28;

void require_success(int code, const char* what, const std::string& path) {
  if (code == MPI_SUCCESS) return;
  std::array<char, MPI_MAX_ERROR_STRING + 1> text{};
  int length = 0, error_class = 0;
  MPI_Error_string(code, text.data(), &length);
  MPI_Error_class(code, &error_class);
  const auto reason = error_class == MPI_ERR_NO_SPACE ? std::errc::no_space_on_device
                      : error_class == MPI_ERR_ACCESS ? std::errc::permission_denied
                      : error_class == MPI_ERR_QUOTA  ? std::errc::no_space_on_device
                                                      : std::errc::io_error;
  throw fs::filesystem_error(fmt::format("{} ({})", what, text.data()), path, std::make_error_code(reason));
}

/// Writing together counts as time in messages, since ranks wait for each other in it.
template <class Call>
int waiting_for_others(Call call) {
  const session::MessageScope timed;
  return call();
}

/// An empty place beside the file, and a folder for it. What is there stays until the new one is whole.
void prepare(const std::string& path, const std::string& unfinished) {
  const fs::path folder = fs::path(path).parent_path();
  if (!folder.empty()) fs::create_directories(folder);
  if (fs::exists(path) && !fs::is_regular_file(path)) {
    throw fs::filesystem_error("this is no file that could be replaced", path,
                               std::make_error_code(std::errc::invalid_argument));
  }
  fs::remove(unfinished);  // a link too, not what it points to
}

/// Closes the file whatever happens. Collective.
void work_and_close(const Communicator& communicator, SharedFile::Handle& handle,
                    const std::function<void(SharedFile&)>& work, Named named) {
  try {
    agree(communicator, [&] {
      SharedFile file(handle);
      work(file);
    });
  } catch (const CollectiveError&) {
    MPI_File_close(&handle.file);
    throw;
  }
  // A file system may put off writing and fail at it later: closing through MPI would not tell.
  const int synchronized = named == Named::when_on_disk ? MPI_File_sync(handle.file) : MPI_SUCCESS;
  const int closed = waiting_for_others([&] { return MPI_File_close(&handle.file); });
  agree(communicator, [&] {
    require_success(synchronized, "cannot write", handle.path);
    require_success(closed, "cannot close", handle.path);
  });
}

}  // namespace

void SharedFile::write(std::int64_t offset, std::span<const std::byte> bytes) {
  for (std::size_t begin = 0; begin < bytes.size(); begin += largest_transfer) {
    const std::size_t count = std::min(largest_transfer, bytes.size() - begin);
    MPI_Status status;
    require_success(MPI_File_write_at(_handle.file, offset + static_cast<std::int64_t>(begin),
                                      bytes.data() + begin, static_cast<int>(count), MPI_BYTE, &status),
                    "cannot write", _handle.path);
    int written = 0;
    MPI_Get_count(&status, MPI_BYTE, &written);
    if (static_cast<std::size_t>(written) != count) {
      throw fs::filesystem_error(fmt::format("wrote {} of {} bytes", written, count), _handle.path,
                                 std::make_error_code(std::errc::no_space_on_device));
    }
  }
}

void write_shared_file(const Communicator& communicator, const std::string& path,
                       const std::function<void(SharedFile&)>& work, Named named) {
  SharedFile::Handle handle{path + ".unfinished", MPI_FILE_NULL};
  on_root(communicator, [&] { prepare(path, handle.path); });
  const int opened = waiting_for_others([&] {
    return MPI_File_open(host_communicator(communicator), handle.path.c_str(),
                         MPI_MODE_CREATE | MPI_MODE_WRONLY, MPI_INFO_NULL, &handle.file);
  });
  try {
    // Closing is collective: where some ranks have not opened the file, the others cannot close it.
    agree(communicator, [&] { require_success(opened, "cannot create", handle.path); });
    work_and_close(communicator, handle, work, named);
    on_root(communicator, [&] { fs::rename(handle.path, path); });
  } catch (const CollectiveError&) {
    if (communicator.is_root()) {
      std::error_code ignored;
      fs::remove(handle.path, ignored);
    }
    communicator.barrier();
    throw;
  }
}

}  // namespace aeroloom::parallel
