#include "pipeline/output_lock.hpp"

#include "parallel/communication/collective_error.hpp"

#include <array>
#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace aeroloom::pipeline {
namespace {

/// Two runs may take turns at removing the file and making a new one; who holds a file that has no name any
/// more tries again. Two turns are enough for two; chosen, not measured.
constexpr int most_attempts = 10;

enum class Attempt { locked, held_by_another, without_locks, gone };

Attempt lock(int file, const std::string& path) {
  struct flock whole {};
  whole.l_type = F_WRLCK;
  whole.l_whence = SEEK_SET;
  if (fcntl(file, F_OFD_SETLK, &whole) != 0)
    return errno == EAGAIN || errno == EACCES ? Attempt::held_by_another : Attempt::without_locks;
  struct stat held {
  }, named{};
  const bool same = fstat(file, &held) == 0 && stat(path.c_str(), &named) == 0 &&
                    held.st_ino == named.st_ino && held.st_dev == named.st_dev;
  return same ? Attempt::locked : Attempt::gone;
}

std::string read_holder(int file) {
  std::array<char, 300> text{};
  const ssize_t count = pread(file, text.data(), text.size() - 1, 0);
  std::string holder(text.data(), count > 0 ? static_cast<std::size_t>(count) : 0);
  while (holder.ends_with('\n')) holder.pop_back();
  return holder.empty() ? "another process" : holder;
}

void write_holder(int file) {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  const std::string holder = fmt::format("process {} on {}\n", getpid(), host.data());
  // Who holds the folder is said for others to read; that it is held does not depend on it.
  if (ftruncate(file, 0) == 0 && pwrite(file, holder.data(), holder.size(), 0) < 0) return;
}

/// Not open where the file system has no locks.
parallel::FileDescriptor lock_folder(const std::string& folder, const std::string& path) {
  for (int attempt = 0; attempt < most_attempts; ++attempt) {
    parallel::FileDescriptor file(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644));
    if (!file.is_open()) {
      throw std::filesystem::filesystem_error("cannot lock", path,
                                              std::error_code(errno, std::generic_category()));
    }
    switch (lock(file.number(), path)) {
      case Attempt::locked:
        write_holder(file.number());
        return file;
      case Attempt::without_locks:
        return {};
      case Attempt::held_by_another:
        throw std::filesystem::filesystem_error(
            fmt::format("another run writes there ({}). Remedy: another output.directory, or wait for it",
                        read_holder(file.number())),
            folder, std::make_error_code(std::errc::device_or_resource_busy));
      case Attempt::gone:
        break;
    }
  }
  return {};
}

}  // namespace

OutputLock::OutputLock(const parallel::Communicator& communicator, const std::string& folder)
    : _path((std::filesystem::path(folder) / ".lock").string()) {
  parallel::on_root(communicator, [&] { _file = lock_folder(folder, _path); });
}

OutputLock::~OutputLock() {
  if (_file.is_open()) unlink(_path.c_str());
}

}  // namespace aeroloom::pipeline
