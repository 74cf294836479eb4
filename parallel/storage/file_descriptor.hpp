/// File descriptors. Internal to parallel/.
#pragma once

#include <cerrno>
#include <cstddef>
#include <span>
#include <system_error>
#include <utility>

#include <unistd.h>

namespace aeroloom::parallel {

/// Owns a file descriptor.
class FileDescriptor {
public:
  FileDescriptor() = default;
  explicit FileDescriptor(int number) : _number(number) {}
  FileDescriptor(FileDescriptor&& other) noexcept : _number(std::exchange(other._number, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(_number, other._number);
    return *this;
  }
  ~FileDescriptor() { close(); }
  int number() const { return _number; }
  bool is_open() const { return _number >= 0; }
  void close() {
    if (_number >= 0) ::close(std::exchange(_number, -1));
  }

private:
  int _number = -1;
};

/// Throws std::system_error with the text of errno.
[[noreturn]] inline void throw_system_error(const char* operation) {
  throw std::system_error(errno, std::generic_category(), operation);
}

/// Writes everything; false when the system refuses.
inline bool write_all(int descriptor, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace aeroloom::parallel
