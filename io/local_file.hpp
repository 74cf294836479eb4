/// A file that one rank writes alone, and is not to be seen before it is complete.
#pragma once

#include <cstddef>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aeroloom::io {

/// Writes one after another through a buffer of fixed size. All throw std::filesystem::filesystem_error with
/// the path and the reason.
class LocalFile {
public:
  explicit LocalFile(std::string path);

  void text(std::string_view text) { write(std::as_bytes(std::span(text))); }
  template <class T>
  void items(std::span<const T> items) {
    write(std::as_bytes(items));
  }
  template <class T>
  void item(const T& item) {
    write(std::as_bytes(std::span(&item, 1)));
  }
  void write(std::span<const std::byte> bytes);
  /// All is handed over to the file system, and the file closed, which reports what a server refuses. It is
  /// not waited for the disk: a mesh may have thousands of such files. Without it the file may be cut short.
  void finish();

private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  [[noreturn]] void fail(const char* what) const;
  void flush();

  std::string _path;
  std::unique_ptr<std::FILE, Close> _file;
  std::vector<std::byte> _buffer;
};

}  // namespace aeroloom::io
