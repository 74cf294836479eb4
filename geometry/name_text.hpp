/// Names in files whose 8-bit encoding nobody declares, as UTF-8.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace aeroloom::geometry {

/// Whether a text is valid UTF-8 (RFC 3629), as ASCII is.
bool is_utf8(std::string_view text);
bool is_ascii(std::string_view text);

/// A text with bytes above 127 as \xHH, for messages.
std::string shown_bytes(std::string_view text);

/// Throws std::invalid_argument for an encoding that the C library does not know, or that does not keep
/// ASCII, as UTF-16. Empty is no encoding, and accepted.
void require_encoding(const std::string& encoding);

struct DecodedName {
  std::string text;    ///< UTF-8
  std::string change;  ///< how the name was read, for the log; empty for UTF-8
};

/// Decodes the names of one file, in order. A name is UTF-8 if it is valid. Otherwise it is in `encoding`, a
/// name that iconv of the C library knows, such as "GB18030". Without one, or where a name is invalid in it,
/// each byte is a character of latin-1, so that nothing is lost. In a file with other names than UTF-8, a
/// name in an encoding with several bytes a character may be valid UTF-8 by chance: `encoding` then holds,
/// unless the name has characters of three bytes, which are hardly chance. Different names stay different: a
/// number is appended where they would be equal. Throws as require_encoding().
std::vector<DecodedName> decode_names(const std::vector<std::string>& names,
                                      const std::string& encoding = "");

}  // namespace aeroloom::geometry
