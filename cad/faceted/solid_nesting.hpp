/// Which solids enclose each chamber, and which of them fill it. Internal to cad/faceted/.
#pragma once

#include "cad/faceted/facet_solids.hpp"
#include "cad/repair/change.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::cad {

/// Whether solids that share a part of their volume, neither within the other, are an error.
enum class OverlappingSolids : std::uint8_t { refuse, fill };

/// What decides which chambers are material.
struct NestingRules {
  std::vector<std::string> voids;  ///< patterns for names of solids
  OverlappingSolids overlapping = OverlappingSolids::refuse;
};

struct SolidNesting {
  std::vector<char> filled;          ///< per chamber
  std::vector<std::int32_t> filler;  ///< per chamber: the solid that fills it, or -1
  std::int32_t nested = 0;           ///< number of solids within others that are regions
};

/// A solid within another one is a region of its own, unless it is turned the other way than the one around
/// it, or a pattern of the rules has its name: then it is a void. Solids in voids are regions. Solids that
/// are turned both ways are voids too. Each nested solid is listed. `beside` are the chambers on both sides
/// of each triangle. Throws CadError for solids that overlap, and for a pattern without a match.
SolidNesting nest_solids(const FacetSoup& soup, const FacetSolids& solids,
                         const std::vector<std::array<std::int32_t, 2>>& beside, std::size_t chambers,
                         const NestingRules& rules, Changes& changes);

}  // namespace aeroloom::cad
