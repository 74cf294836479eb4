/// The lengths that a case gives, and whether they are lengths of its model.
#pragma once

#include "geometry/vec.hpp"
#include "pipeline/case/case.hpp"

#include <string>
#include <vector>

namespace aeroloom::cases {

class KeyTable;

/// All lengths and places that were given, in the order of keys. Those counted in reference lengths have
/// these as their unit.
std::vector<GivenLength> given_lengths(const KeyTable& keys, double reference_length);

/// What is wrong with the first length that is no length of the model; empty: nothing. A length is 1e-9 to
/// 1e9 times the largest extent of `body`, and a hundred times what numbers are apart at its farthest
/// coordinate, at least; a place is no farther than that from `body`.
std::string fault_of_lengths(const std::vector<GivenLength>& lengths, const geometry::Box& body);

}  // namespace aeroloom::cases
