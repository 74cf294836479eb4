/// Triangles of a faceted file as they stand there, before anything is repaired.
///
/// STL (ASCII, binary), OBJ, OFF (with normals, colours), PLY (ASCII, binary) and TetGen's .poly and .smesh.
/// Polygons are cut into triangles; a planar facet of .poly may have holes, inner outlines and loose
/// segments.
#pragma once

#include "geometry/vec.hpp"

#include <array>
#include <cmath>
#include <cstddef>
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

inline geometry::Box box_of_points(const std::vector<geometry::Vec3>& points) {
  geometry::Box box;
  for (const geometry::Vec3 p : points) box.add(p);
  return box;
}
inline std::array<geometry::Vec3, 3> corners_of(const FacetSoup& soup, std::size_t triangle) {
  const auto& [a, b, c] = soup.triangles[triangle];
  return {soup.points[a], soup.points[b], soup.points[c]};
}
inline geometry::Vec3 middle_of(const FacetSoup& soup, std::size_t triangle) {
  const auto [a, b, c] = corners_of(soup, triangle);
  return (a + b + c) / 3.0;
}
/// The normal of a triangle times twice its area.
inline geometry::Vec3 area_vector2(const std::array<geometry::Vec3, 3>& corners) {
  return cross(corners[1] - corners[0], corners[2] - corners[0]);
}

/// The coordinate axis that is farthest from a direction.
inline geometry::Vec3 farthest_axis(geometry::Vec3 direction) {
  const double x = std::abs(direction.x), y = std::abs(direction.y), z = std::abs(direction.z);
  if (x <= y && x <= z) return {1, 0, 0};
  return y <= z ? geometry::Vec3{0, 1, 0} : geometry::Vec3{0, 0, 1};
}

/// Whether the file is one of read_facets: by extension, and an .stl by content too, since many programs
/// write "solid" at the head of binary files. False where it cannot be opened.
bool is_faceted_file(const std::string& file);

/// Throws CadError with line or byte for files that are damaged, empty or of another format,
/// std::ios_base::failure where the file cannot be opened.
FacetSoup read_facets(const std::string& file);

}  // namespace aeroloom::cad
