/// The solids of a faceted file: closed sets of triangles that belong together. Internal to cad/faceted/.
#pragma once

#include "cad/faceted/facet_soup.hpp"
#include "cad/repair/change.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::cad {

/// Where the normals of a solid's triangles point, as the file turns them.
enum class SolidTurn : std::uint8_t { outward, inward, both };

struct FacetSolid {
  std::string name;  ///< of the part or group of all its triangles; empty if they have several or none
  /// The group's name is that of the solid, not that of a face: no other solid has triangles in its group.
  bool is_group = false;
  SolidTurn turn = SolidTurn::both;
  std::int32_t triangle = -1;  ///< one of its triangles, before any is left out
};

/// The solids that a triangle bounds: one, or two that touch there; -1: none.
using FacetOwners = std::array<std::int32_t, 2>;

struct FacetSolids {
  std::vector<FacetSolid> solids;
  std::vector<FacetOwners> of;  ///< per triangle
};

/// Components over sides, each within its group if every group is closed on its own; else within its part if
/// every part is; else over all sides. Numbered in the order of the file. Points with equal coordinates must
/// be one.
FacetSolids find_solids(const FacetSoup& soup);

/// The name by which a case calls it, in quotes.
std::string solid_text(const FacetSolids& solids, std::int32_t solid);
/// Its own name or "solid_N".
std::string solid_name(const FacetSolids& solids, std::int32_t solid);

/// Turns the triangles of each component like its first, over sides of two.
void turn_alike(FacetSoup& soup);

/// Drops triangles without area, and all but the first of triangles with the same corners, whose solids the
/// first one gets.
void merge_repeated_triangles(FacetSoup& soup, FacetSolids& solids, Changes& changes);

/// How solids may touch: in any way, or only so that they have parts of faces in common.
enum class TouchingSolids : std::uint8_t { anyhow, in_faces };

/// Cuts triangles of solids that touch along each other, if any do. Throws CadError that names both solids
/// and the place if solids cross, touch in another way, or if what is cut does not fit together. False if
/// there is nothing to cut.
bool imprint_solids(FacetSoup& soup, FacetSolids& solids, TouchingSolids touching, Changes& changes);

}  // namespace aeroloom::cad
