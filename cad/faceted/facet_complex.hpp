/// A repaired faceted model: triangles that enclose regions, divided into faces by curves.
#pragma once

#include "cad/faceted/facet_soup.hpp"
#include "cad/model/model.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::cad {

/// The regions on the two sides of a triangle.
struct FacetRegions {
  RegionId front = no_entity, back = no_entity;  ///< as in Face
  bool cavity = false;                           ///< `back` is a void inside its own region
  friend bool operator==(const FacetRegions&, const FacetRegions&) = default;
};

/// Every point is used. Triangles meet in common points and sides only. Every side has at least two
/// triangles.
struct FacetComplex {
  struct Face : FacetSoup::Group, FacetRegions {};
  /// A chain of sides between two of `vertices`. A closed curve begins and ends at the same vertex.
  struct Curve {
    std::vector<std::int32_t> points;
  };

  std::vector<Vec3> points;
  std::vector<std::array<std::int32_t, 3>>
      triangles;                ///< counter-clockwise seen against the normal, which points out of `front`
  std::vector<FaceId> face_of;  ///< per triangle
  std::vector<Face> faces;      ///< each connected over sides that lie on no curve
  /// Where faces meet, or where one face is sharp. Each side lies on one curve at most.
  std::vector<Curve> curves;
  std::vector<std::int32_t> vertices;  ///< numbers of points, ascending
  std::vector<std::string> regions;    ///< names of regions
  bool united = false;                 ///< components that crossed were united
  bool imprinted = false;              ///< solids that touch were cut along each other
  std::int32_t nested = 0;             ///< number of solids within others that are regions
};

}  // namespace aeroloom::cad
