/// Names as CGNS can hold them.
#pragma once

#include "io/distinct_names.hpp"

#include <cstddef>
#include <string>

namespace aeroloom::io::cgns {

inline constexpr std::size_t longest_name = 32;

/// Gives names to the nodes of one or several parents, no two alike.
class NodeNames {
public:
  /// Keeps a name for a node that has it already.
  void reserve(const std::string& name) { _taken.reserve(name); }

  /// The name itself where it is fit and free. Otherwise: slashes, control characters and blanks at either
  /// end become `_`, as do names of dots alone; what is longer than 32 bytes is cut between two characters
  /// of UTF-8; what is taken gets the first free of _2, _3, ... after it. Empty names become `stand_in`.
  /// `ending` stays whole at the end of the name.
  std::string take(const std::string& wanted, const std::string& stand_in, const std::string& ending = "");

private:
  TakenNames _taken;
};

/// Whether take() could leave the name alone.
bool is_fit(const std::string& name);

}  // namespace aeroloom::io::cgns
