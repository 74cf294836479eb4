/// Small mistakes of CAD programs, made on purpose: to see what comes of them.
#pragma once

#include <random>
#include <string>

#include <TopoDS_Shape.hxx>

namespace aeroloom::mutations {

enum class Mutation {
  vertex_moved,        ///< along one of its curves; curves that end there are drawn to it
  edge_split,          ///< near its end
  face_offset,         ///< its surface alone
  sliver_inserted,     ///< between a face and one of its edges
  tolerances_loosened  ///< of a third of the edges and vertices
};
inline constexpr int mutation_count = 5;

struct Mutated {
  TopoDS_Shape shape;
  std::string what;  ///< one line
};

/// The shape with one mutation at a place that `random` chooses; how far, in shares of the diagonal, too:
/// 1e-8 to 1e-4 for vertices, edges and tolerances, 1e-9 to 1e-6 for offsets, 1e-8 to 1e-5 for slivers.
/// Throws std::runtime_error where no place will do.
Mutated mutate(const TopoDS_Shape& shape, Mutation mutation, std::mt19937& random);

}  // namespace aeroloom::mutations
