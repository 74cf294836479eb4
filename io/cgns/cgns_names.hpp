/// Names that CGNS allows.
#pragma once

#include "io/distinct_names.hpp"

#include <cstddef>
#include <string>

namespace aeroloom::io::cgns {

inline constexpr std::size_t longest_name = 32;

/// Gives names to the nodes of one or several parents, all different.
class NodeNames {
public:
  /// Reserves a name that a node has already.
  void reserve(const std::string& name) { _taken.reserve(name); }

  /// A name close to `wanted`. `ending` stays whole at its end.
  /// - Slashes, control characters and blanks at either end become `_`; so do names of dots alone.
  /// - Names above 32 bytes are cut between two characters of UTF-8. Empty names become `stand_in`.
  /// - Where the name is taken, the first free one of NAME_2, NAME_3, ... is given.
  std::string take(const std::string& wanted, const std::string& stand_in, const std::string& ending = "");

private:
  TakenNames _taken;
};

/// Whether CGNS allows the name as it is.
bool is_fit(const std::string& name);

}  // namespace aeroloom::io::cgns
