/// A text that the CAD library, which reads files by name, reads from memory. Internal to cad/.
#pragma once

#include <string>

namespace aeroloom::cad {

/// A file without a place in any folder; it goes with the object. Throws std::ios_base::failure where the
/// system refuses one.
class MemoryFile {
public:
  explicit MemoryFile(const std::string& bytes);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  /// The name under which this process opens it.
  const std::string& path() const { return _path; }

private:
  int _descriptor = -1;
  std::string _path;
};

}  // namespace aeroloom::cad
