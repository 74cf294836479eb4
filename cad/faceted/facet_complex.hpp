/// Flat triangles that enclose regions, cut into faces along curves: a faceted model once it is repaired.
#pragma once

#include "cad/faceted/facet_soup.hpp"
#include "cad/model/model.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::cad {

/// What a triangle lies between.
struct FacetSkin {
  RegionId front = no_entity, back = no_entity;  ///< as in Face
  bool cavity = false;                           ///< beyond it lies a void that is enclosed by its region
  friend bool operator==(const FacetSkin&, const FacetSkin&) = default;
};

/// Every point is used. Triangles meet in common points and sides only, and every side has two or more of
/// them.
struct FacetComplex {
  struct Face : FacetSoup::Group, FacetSkin {};
  /// A chain of sides between two of `vertices`; a closed one begins and ends with the same vertex.
  struct Curve {
    std::vector<std::int32_t> points;
  };

  std::vector<Vec3> points;
  std::vector<std::array<std::int32_t, 3>>
      triangles;                ///< counter-clockwise seen against the normal out of `front`
  std::vector<FaceId> face_of;  ///< of each triangle
  std::vector<Face> faces;      ///< each connected across sides that lie on no curve
  /// Where faces meet, or a face meets itself at a sharp angle; each side on one curve at most.
  std::vector<Curve> curves;
  std::vector<std::int32_t> vertices;  ///< points, ascending
  std::vector<std::string> regions;    ///< names of what is enclosed
  bool united = false;                 ///< components that crossed became one
};

}  // namespace aeroloom::cad
