/// A file that one rank writes alone. Give it a temporary name, and rename it when it is complete.
#pragma once

#include <cstddef>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aeroloom::io {

/// Appends to a new file through a buffer of fixed size. All functions throw
/// std::filesystem::filesystem_error with the path and the reason.
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
  /// Writes the rest and closes the file. Errors of a file server show here. Does not wait for the disk, as a
  /// mesh may have thousands of such files. Without this call the end of the file may be missing.
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
