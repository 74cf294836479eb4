/// Files as OpenFOAM reads them: a header and lists, text or binary.
#pragma once

#include "io/local_file.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace aeroloom::io {

struct FoamFormat {
  bool binary = true;
  int label_bits = 32;  ///< 32 or 64
};

/// The header of a file: `kind` is its class, `location` the folder it names, `note` may be empty.
std::string foam_header(const FoamFormat& format, std::string_view kind, std::string_view location,
                        std::string_view object, std::string_view note = {});

/// Writes a list item by item, in constant memory.
class FoamList {
public:
  /// A list of `count` items; what leads to it (a keyword, `List<label>`) is written before.
  FoamList(LocalFile& file, const FoamFormat& format, std::int64_t count);
  void label(std::int64_t value);
  void vector(const double* xyz);
  void flag(bool value);
  /// Closes the list.
  void end();

private:
  LocalFile& _file;
  FoamFormat _format;
  std::int64_t _count;
};

}  // namespace aeroloom::io
