/// Triangles of a faceted file as they stand there, before anything is repaired.
///
/// STL (ASCII, binary), OBJ, OFF (with normals, colours), PLY (ASCII, binary) and TetGen's .poly and .smesh.
/// Polygons are cut into triangles; a planar facet of .poly may have holes, inner outlines and loose
/// segments.
#pragma once

#include "geometry/vec.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::cad {

/// What the triangles enclose: every second space from outside inwards is material (`alternating`), or all
/// spaces are but those with a hole point (`all`, TetGen's rule).
enum class Filling { alternating, all };

struct FacetSoup {
  /// What the file tells apart by name: solids, objects, groups, materials, boundary markers.
  struct Group {
    std::string name, part;  ///< empty where the file gives none
    /// Of faces of CAD that became triangles, as in FaceTag; a patch of its own where it is not empty.
    std::string patch = {}, layer = {}, colour = {};
    std::int32_t number = -1;
    friend bool operator==(const Group&, const Group&) = default;
  };
  struct RegionPoint {
    geometry::Vec3 point;
    std::string name;
  };

  std::string file, format;
  std::vector<geometry::Vec3> points;  ///< finite
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::int32_t> group_of;  ///< of each triangle, into groups
  std::vector<Group> groups;
  Filling filling = Filling::alternating;
  std::vector<geometry::Vec3> holes;  ///< points in spaces that are no material
  std::vector<RegionPoint> regions;   ///< points in spaces that have a name
};

/// Whether the file is one of read_facets: by extension, and an .stl by content too, since many programs
/// write "solid" at the head of binary files. False where it cannot be opened.
bool is_faceted_file(const std::string& file);

/// Throws CadError with line or byte for files that are damaged, empty or of another format,
/// std::ios_base::failure where the file cannot be opened.
FacetSoup read_facets(const std::string& file);

}  // namespace aeroloom::cad
