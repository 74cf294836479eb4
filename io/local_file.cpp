#include "io/local_file.hpp"

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

namespace aeroloom::io {

namespace {

constexpr std::size_t write_buffer_size = std::size_t{1} << 20;

}  // namespace

LocalFile::LocalFile(std::string path) : _path(std::move(path)) {
  // Made anew: what is there may be a link to another file.
  std::error_code ignored;
  std::filesystem::remove(_path, ignored);
  errno = 0;
  _file.reset(std::fopen(_path.c_str(), "wbx"));
  if (!_file) fail("cannot create");
  std::setvbuf(_file.get(), nullptr, _IONBF, 0);
  _buffer.reserve(write_buffer_size);
}

void LocalFile::fail(const char* what) const {
  throw std::filesystem::filesystem_error(what, _path, std::error_code(errno, std::generic_category()));
}

void LocalFile::flush() {
  if (std::fwrite(_buffer.data(), 1, _buffer.size(), _file.get()) != _buffer.size()) fail("cannot write");
  _buffer.clear();
}

void LocalFile::write(std::span<const std::byte> bytes) {
  if (_buffer.size() + bytes.size() > write_buffer_size) flush();
  if (bytes.size() >= write_buffer_size) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), _file.get()) != bytes.size()) fail("cannot write");
    return;
  }
  _buffer.insert(_buffer.end(), bytes.begin(), bytes.end());
}

void LocalFile::finish() {
  flush();
  if (std::fclose(_file.release()) != 0) fail("cannot write");
}

}  // namespace aeroloom::io
