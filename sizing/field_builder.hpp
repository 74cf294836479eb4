/// Builds size fields: octree, sizes at its nodes, hanging nodes.
#pragma once

#include "sizing/size_field.hpp"
#include "sizing/sources.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace aeroloom::sizing {

/// Where neighbours differ by more, sizes are no field any more.
inline constexpr double largest_growth = 10;

/// Throws std::invalid_argument, naming the option, unless 0 < minimum <= maximum, growth > 1,
/// 0 < curvature_angle < 180 and surface_maximum is 0 or at least the minimum.
void check_options(const SizingOptions& options);

/// One build of a field. Sizes are those of the cheapest source, size + ln(growth) * distance; they are found
/// by a front that runs over the octree's nodes in ascending size and carries along which source each node
/// obeys (Dijkstra, Numer. Math. 1, 1959, doi:10.1007/BF01386390, with distances to the source, not along the
/// path).
class FieldBuilder {
public:
  FieldBuilder(const geometry::Box& domain, const SizingOptions& options);
  /// Starts from a field that the new one must nowhere exceed.
  explicit FieldBuilder(const SizeField& previous);

  /// The field under these sources, whose sizes may lie below the minimum. Called once.
  SizeField build(std::span<const SizeSource> sources);
  /// As above; nothing, at less cost, where the field has clearly more than `most_leaves`.
  std::optional<SizeField> build_within(std::span<const SizeSource> sources, std::int64_t most_leaves);

private:
  /// The octree of the present split cells with, per node, the size and the node whose seed it obeys.
  struct Sizes {
    SplitCubes::Leaves leaves;
    LeafTable table;
    OctreeNodes nodes;
    std::vector<double> size;
    std::vector<std::int32_t> seed;  // -1 where none asks for less than the bound
    std::vector<double> seed_size;   // of the node itself; the maximum where it is no seed
  };

  void split_at_sources();
  Sizes solve();
  void bound_sizes(Sizes& sizes) const;
  void plant_seeds(Sizes& sizes) const;
  void run_front(Sizes& sizes) const;
  /// False where that would take more cubes than that; some are split then.
  bool split_where_coarse(const Sizes& sizes, std::int64_t most_cubes);
  SizeField finish(Sizes sizes) const;

  double distance(GridPoint a, GridPoint b) const;

  geometry::Box _domain;
  SizingOptions _options;
  const SizeField* _previous = nullptr;
  RootCube _root;
  double _slope;
  SplitCubes _cells;
  std::vector<SizeSource> _sources;
};

}  // namespace aeroloom::sizing
