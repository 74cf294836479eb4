#include "cad/read/memory_file.hpp"

#include <cerrno>
#include <ios>
#include <system_error>

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

namespace aeroloom::cad {

namespace {

[[noreturn]] void throw_memory_error(int code) {
  throw std::ios_base::failure("cannot keep a file in memory",
                               std::error_code(code, std::generic_category()));
}

}  // namespace

MemoryFile::MemoryFile(const std::string& bytes) : _descriptor(memfd_create("aeroloom", MFD_CLOEXEC)) {
  if (_descriptor < 0) throw_memory_error(errno);
  _path = fmt::format("/proc/self/fd/{}", _descriptor);
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count = ::write(_descriptor, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      const int code = count < 0 ? errno : ENOSPC;
      ::close(_descriptor);
      throw_memory_error(code);
    }
    done += static_cast<std::size_t>(count);
  }
}

MemoryFile::~MemoryFile() {
  ::close(_descriptor);
}

}  // namespace aeroloom::cad
