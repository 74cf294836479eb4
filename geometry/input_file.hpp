/// Files that users give: whether a path can be read as one, and its text.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace aeroloom::geometry {

/// Why a path cannot be read as a file.
struct FileRefusal {
  std::string what;  ///< "no such file or directory", with a remedy where there is one
  std::error_code code;
};

/// Nothing where `path` is a plain file, or a link to one, that may be read. Pipes, sockets and devices are
/// none: they may never end, and cannot be read twice. The null device is an empty file. Waits for nothing.
std::optional<FileRefusal> refusal_of(const std::string& path);

/// Throws std::ios_base::failure: "cannot read 'PATH': WHAT".
void require_readable(const std::string& path);

/// The length of the mark of UTF-8 (a byte-order mark) that a text begins with, which some editors put there:
/// 3 or 0.
std::size_t mark_length(std::string_view text);

/// All bytes of a file. Throws as require_readable().
std::string read_whole(const std::string& path);

}  // namespace aeroloom::geometry
