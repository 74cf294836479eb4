/// The folder of real geometry that tests look for, and small damaged files.
#pragma once

#include "tests/source_tree.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <unistd.h>

namespace aeroloom::cad::real {

inline std::filesystem::path folder() {
  if (const char* set = std::getenv("AEROLOOM_GEOMETRY")) return set;
  return source_tree() / ".." / "shared" / "geometry";
}

inline std::string file(const std::string& name) {
  return (folder() / name).string();
}
inline bool has(const std::string& name) {
  return std::filesystem::exists(folder() / name);
}

inline std::string read(const std::string& name) {
  std::ifstream stream(file(name), std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A file in the temporary folder, removed at the end of the scope.
class TemporaryFile {
public:
  TemporaryFile(const std::string& name, const std::string& content)
      : _path(std::filesystem::temp_directory_path() /
              ("aeroloom_" + std::to_string(::getpid()) + "_" + name)) {
    std::ofstream(_path, std::ios::binary) << content;
  }
  ~TemporaryFile() { std::filesystem::remove(_path); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  std::string path() const { return _path.string(); }

private:
  std::filesystem::path _path;
};

}  // namespace aeroloom::cad::real
