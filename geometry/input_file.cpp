#include "geometry/input_file.hpp"

#include <cerrno>
#include <fstream>
#include <ios>
#include <iterator>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

namespace aeroloom::geometry {

namespace {

FileRefusal refusal_by(int code) {
  const std::error_code reason(code, std::generic_category());
  return {reason.message(), reason};
}

bool is_null_device(const struct stat& status) {
  constexpr unsigned memory_devices = 1, null_device = 3;
  return S_ISCHR(status.st_mode) && status.st_rdev == makedev(memory_devices, null_device);
}

}  // namespace

std::optional<FileRefusal> refusal_of(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return refusal_by(errno);
  if (S_ISDIR(status.st_mode)) return refusal_by(EISDIR);
  if (!S_ISREG(status.st_mode) && !is_null_device(status)) {
    return FileRefusal{
        "a device or a pipe, which cannot be read twice. Remedy: copy what it gives into a file, and name "
        "that",
        std::make_error_code(std::errc::invalid_argument)};
  }
  // Should something else stand there by now, it is not waited for.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return refusal_by(errno);
  ::close(descriptor);
  return std::nullopt;
}

void require_readable(const std::string& path) {
  const std::optional<FileRefusal> refusal = refusal_of(path);
  if (!refusal) return;
  // The system's words come with the code.
  const bool is_of_system = refusal->what == refusal->code.message();
  throw std::ios_base::failure(is_of_system ? fmt::format("cannot read '{}'", path)
                                            : fmt::format("cannot read '{}': {}", path, refusal->what),
                               refusal->code);
}

std::size_t mark_length(std::string_view text) {
  constexpr std::string_view mark = "\xEF\xBB\xBF";
  return text.starts_with(mark) ? mark.size() : 0;
}

std::string read_whole(const std::string& path) {
  require_readable(path);
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream) {
    throw std::ios_base::failure(fmt::format("cannot read '{}'", path),
                                 std::error_code(errno != 0 ? errno : EIO, std::generic_category()));
  }
  return text;
}

}  // namespace aeroloom::geometry
