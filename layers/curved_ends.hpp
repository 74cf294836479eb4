/// Curved faces that layers end on. Columns there follow the CAD surface, so they are curved.
#pragma once

#include "geometry/vec.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace aeroloom::layers {

/// What the nodes of a column at the rim of such faces are put onto: a CAD face, or the CAD edge between two.
struct EndPlace {
  std::int32_t face = -1, edge = -1;   ///< one of both is -1
  std::array<double, 2> parameters{};  ///< of the wall vertex; on an edge the first
  /// Unit vectors at right angles to which the column starts; on a face the second is zero.
  std::array<geometry::Vec3, 2> across;
};

/// What the columns of a wall follow at the rims of curved faces.
struct EndPlaces {
  std::vector<std::int32_t> of;  ///< by vertex: its place, or -1
  std::vector<EndPlace> places;

  const EndPlace* at(std::int32_t vertex) const { return of[vertex] < 0 ? nullptr : &places[of[vertex]]; }
};

/// The CAD surfaces of the faces. Results depend on the arguments alone.
class CurvedEnds {
public:
  CurvedEnds() = default;
  CurvedEnds(const CurvedEnds&) = delete;
  CurvedEnds& operator=(const CurvedEnds&) = delete;
  virtual ~CurvedEnds() = default;

  /// The unit normal out of the fluid of a face at a point on it; zero where it has none.
  virtual geometry::Vec3 normal(std::int32_t face, geometry::Vec3 point) const = 0;
  /// What a column follows from a point at which these different faces meet the wall. Nothing where they have
  /// no face or edge there in common.
  virtual std::optional<EndPlace> place(std::span<const std::int32_t> faces, geometry::Vec3 point) const = 0;
  /// The nearest point on the face or edge of a place.
  virtual geometry::Vec3 onto(const EndPlace& place, geometry::Vec3 point) const = 0;
};

}  // namespace aeroloom::layers
