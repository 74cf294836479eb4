#include "improve/operations/operations.hpp"

#include "improve/operations/edge_contraction.hpp"
#include "improve/operations/small_polyhedron.hpp"
#include "improve/operations/swap.hpp"
#include "improve/operations/vertex_insertion.hpp"
#include "improve/operations/vertex_moves.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>

namespace aeroloom::improve {
namespace {

template <class Type>
std::unique_ptr<LocalOperation> make(const OperationContext& context) {
  if constexpr (std::is_constructible_v<Type, const OperationContext&>) {
    return std::make_unique<Type>(context);
  } else {
    return std::make_unique_for_overwrite<Type>();  // some have large memories, which need no zeros
  }
}

/// Of the local target: operations that replace a whole cavity cost much, and are for the worst tetrahedra.
/// Chosen, not measured.
constexpr double worth_moving = 0.9;
constexpr double worth_adding = 0.75;
constexpr bool costly = true;

/// In the order in which they are tried. docs/improvement.md shows the same table to readers.
constexpr std::array all{
    ListedOperation{"swap", 1, 1, !costly, make<Swap>},
    ListedOperation{"smoothing", 1, 1, !costly, make<VertexSmoothing>},
    ListedOperation{"contraction", 3, worth_moving, !costly, make<EdgeContraction>},
    ListedOperation{"vertex reinsertion", 3, worth_moving, !costly, make<VertexReinsertion>},
    ListedOperation{"vertex insertion", 4, worth_adding, costly, make<VertexInsertion>},
    ListedOperation{"sliding", 3, 1, costly, make<VertexSliding>},
    ListedOperation{"polyhedron search", 4, 1, costly, make<SmallPolyhedron>},
};

constexpr int latest(int sweep, bool with_costly) {
  int level = 0;
  for (const ListedOperation& each : all) {
    if (each.from_sweep <= sweep && (with_costly || !each.is_costly))
      level = std::max(level, each.from_sweep);
  }
  return level;
}

constexpr int any_sweep = std::numeric_limits<int>::max();

}  // namespace

std::span<const ListedOperation> operations() {
  return all;
}

int level_of_sweep(int sweep) {
  return latest(sweep, costly);
}

int last_level() {
  return latest(any_sweep, costly);
}

int last_level_in_narrow_regions() {
  return latest(any_sweep, !costly);
}

}  // namespace aeroloom::improve
