#include "io/streams/range_reader.hpp"

#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace aeroloom::io {

namespace {

[[noreturn]] void throw_file_error(const char* what, const std::string& path, int code) {
  throw std::filesystem::filesystem_error(what, path, std::error_code(code, std::generic_category()));
}

}  // namespace

RangeReader::RangeReader(std::string path) : _path(std::move(path)) {
  // Not to wait for the other end of a pipe.
  _descriptor = ::open(_path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (_descriptor < 0) throw_file_error("cannot open", _path, errno);
  struct stat status {};
  const int code = ::fstat(_descriptor, &status) != 0 ? errno : S_ISREG(status.st_mode) ? 0 : EINVAL;
  if (code != 0) {
    ::close(_descriptor);
    throw_file_error("no plain file", _path, code);
  }
  _size = status.st_size;
}

RangeReader::~RangeReader() {
  ::close(_descriptor);
}

void RangeReader::read_bytes(std::int64_t offset, std::span<std::byte> to) {
  while (!to.empty()) {
    const ssize_t count = ::pread(_descriptor, to.data(), to.size(), offset);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw_file_error("cannot read", _path, errno);
    if (count == 0) fail(offset, "the file ends here, in the middle of its data");
    offset += count;
    to = to.subspan(static_cast<std::size_t>(count));
  }
}

void RangeReader::fail(std::int64_t offset, const std::string& what) const {
  throw std::runtime_error(fmt::format("{}, byte {}: {}", _path, offset, what));
}

}  // namespace aeroloom::io
