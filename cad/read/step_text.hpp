/// Strings of STEP files in 8-bit encodings that nothing declares. Internal to cad/.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace aeroloom::cad {

/// A string that was decoded.
struct DecodedString {
  std::string text;    ///< as the CAD library reads it, but for escapes in it
  std::string change;  ///< geometry::DecodedName::change
};

/// A STEP file whose strings all are ASCII or UTF-8. Others were decoded (geometry::decode_names) and written
/// as escapes of STEP (ISO 10303-21, \X2\ to \X0\).
struct StepText {
  std::string bytes;
  std::vector<DecodedString> decoded;  ///< of the DATA section
};

/// The text of a STEP file; nothing if its strings are ASCII or UTF-8 already, as the CAD library takes them.
/// Throws std::ios_base::failure if the file cannot be read, and std::invalid_argument for an unknown
/// encoding.
std::optional<StepText> decode_step(const std::string& file, const std::string& encoding);

}  // namespace aeroloom::cad
