/// Writes OpenFOAM files: a header, and lists in text or binary.
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

/// The header of a file. `kind`: its class; `location`: the folder in the case; `note` may be empty.
std::string foam_header(const FoamFormat& format, std::string_view kind, std::string_view location,
                        std::string_view object, std::string_view note = {});

/// Writes a list item by item, in constant memory.
class FoamList {
public:
  /// Begins a list of `count` items. The caller has written the keyword or `List<label>` before it.
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
