/// A triangle soup: the triangles of a faceted file before any repair.
///
/// Formats are STL (ASCII, binary), OBJ, OFF (with normals, colours), PLY (ASCII, binary) and TetGen's .poly
/// and .smesh. Polygons are triangulated. A planar facet of .poly may have holes, inner outlines and loose
/// segments.
#pragma once

#include "cad/model/patch_origin.hpp"
#include "geometry/vec.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace aeroloom::cad {

/// Which spaces between the triangles are material: every second one from outside inward (`alternating`), or
/// all without a hole point (`all`, the rule of TetGen).
enum class Filling { alternating, all };

struct FacetSoup {
  /// Names in the file: solids, objects, groups, materials, boundary markers.
  struct Group {
    std::string name, part;  ///< empty if the file gives none
    /// For CAD faces that were triangulated, as in FaceTag. A group with a patch name is a patch of its own.
    std::string patch = {}, layer = {}, colour = {};
    std::int32_t number = -1;
    bool cap = false;  ///< closes an opening
    PatchOrigin origin = PatchOrigin::file;
    friend bool operator==(const Group&, const Group&) = default;
  };
  struct RegionPoint {
    geometry::Vec3 point;
    std::string name;
  };

  std::string file, format;
  std::vector<std::string> read_otherwise = {};  ///< names that are not UTF-8 in the file, a sentence each
  std::vector<geometry::Vec3> points;            ///< finite
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::int32_t> group_of;  ///< per triangle, index into groups
  std::vector<Group> groups;
  Filling filling = Filling::alternating;
  std::vector<geometry::Vec3> holes;  ///< points in spaces that are not material
  std::vector<RegionPoint> regions;   ///< points in spaces with a name
  std::size_t cut_names = 0;          ///< names that were too long (geometry::longest_name)
  std::size_t zeroed = 0;             ///< coordinates that bound_coordinates() has set to zero
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
/// The normal of a triangle, as long as twice its area.
inline geometry::Vec3 area_vector2(const std::array<geometry::Vec3, 3>& corners) {
  return cross(corners[1] - corners[0], corners[2] - corners[0]);
}

/// The coordinate axis with the largest angle to a direction.
inline geometry::Vec3 farthest_axis(geometry::Vec3 direction) {
  const double x = std::abs(direction.x), y = std::abs(direction.y), z = std::abs(direction.z);
  if (x <= y && x <= z) return {1, 0, 0};
  return y <= z ? geometry::Vec3{0, 1, 0} : geometry::Vec3{0, 0, 1};
}

/// Whether read_facets can read the file. The extension decides, for .stl the content too: many programs
/// write "solid" at the head of binary files. False if the file cannot be opened.
bool is_faceted_file(const std::string& file);

/// The file of points that a file of triangles refers to instead of having its own: NAME.node beside a .poly
/// or .smesh whose number of points is 0. Nothing for all others, and for files that cannot be read.
std::optional<std::string> points_beside(const std::string& file);

/// Sets coordinates to zero that are smaller than 2^-120 of the largest one, or than 1e-45: no arithmetic on
/// the body tells them apart, but products of them leave the range of numbers, and exact predicates are exact
/// no more.
/// Throws CadError where the largest coordinate is above 1e30 or, unless it is 0, below 1e-30.
void bound_coordinates(FacetSoup& soup);

/// Names that are not UTF-8 are in `encoding` (geometry::decode_names). Throws CadError with line or byte for
/// files that are damaged, empty or of another format, and std::ios_base::failure if the file cannot be
/// opened.
FacetSoup read_facets(const std::string& file, const std::string& encoding = "");

}  // namespace aeroloom::cad
