/// The worst places of a mesh, and the search for them.
#pragma once

#include "mesh/quality/flaws.hpp"
#include "parallel/communication/communicator.hpp"

#include <array>
#include <vector>

namespace aeroloom::mesh {

/// One of the worst cells by a measure.
struct WorstCellOfShape {
  double value = 0;
  /// Number in the whole mesh: by piece, in a piece tetrahedra, then pyramids, then prisms.
  GlobalIndex cell = 0;
  CellShape shape = CellShape::tetrahedron;
  geometry::Vec3 center;  ///< mean of the corners
};

/// The worst cells by flaw and of all, worst first, ties by number.
struct WorstPlaces {
  std::array<std::vector<FlawedCell>, flaw_count> of;  ///< by Flaw
  std::vector<FlawedCell> all;                         ///< each cell once, by its worst flaw
};

/// Takes `all` anew from `of`.
void list_worst_of_all(WorstPlaces& places);

/// A cell as the search for flaws sees it.
struct CellToJudge {
  CellShape shape = CellShape::tetrahedron;
  GlobalIndex cell = 0;
  geometry::Vec3 center;
  bool in_layers = false;
  double angle = 0, shape_value = 0;  ///< degrees; corner_shape()
  double jump = 0;                    ///< 0: no neighbour is larger
};

/// What one rank knows of the cells seen so far.
class PlaceSearch {
public:
  void add(const CellToJudge& cell);
  /// `layers_unknown`: tetrahedra off layers may be of layers all the same, and are judged by their shape.
  /// Collective; the same on every rank and for any number of ranks.
  WorstPlaces find(const parallel::Communicator& communicator, bool layers_unknown) const;

private:
  using List = std::vector<FlawedCell>;
  static void keep(List& list, const FlawedCell& candidate);

  std::array<List, flaw_count> _of;
  List _tets_by_shape;  // off layers
};

}  // namespace aeroloom::mesh
