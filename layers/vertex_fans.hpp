/// The columns of a vertex that ridges pass or meet at.
#pragma once

#include "layers/ridges.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace aeroloom::layers {

/// Columns over the sides of a ridge, those that part the turn over each of its edges into sectors, and,
/// where more than two edges meet, triangles between columns, whose cells fill what the sectors leave.
struct VertexFan {
  std::vector<geometry::Vec3> directions;  ///< seen along an edge, of about unit length
  std::vector<std::int32_t> of_side;
  std::vector<std::vector<std::int32_t>> across;       ///< by edge: columns from the left side to the right
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< counter-clockwise seen from the fluid
  double visibility = 1;  ///< least dot product of the outer columns with the normals of their sides
};

/// `sectors`: by edge, at least 1; equal on both edges of a ridge that passes. Nothing where columns cannot
/// see each other.
std::optional<VertexFan> make_vertex_fan(const Ridge& ridge, std::span<const std::int32_t> sectors);

}  // namespace aeroloom::layers
