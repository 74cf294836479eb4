/// Builds size fields: octree, sizes at its nodes, hanging nodes.
#pragma once

#include "sizing/field/seed_tree.hpp"
#include "sizing/field/size_field.hpp"
#include "sizing/field/sources.hpp"

#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

namespace aeroloom::sizing {

/// Where neighbours differ by more, sizes are no field any more.
inline constexpr double largest_growth = 10;

/// Throws std::invalid_argument, naming the option, unless 0 < minimum <= maximum, growth > 1,
/// 0 < curvature_angle < 180 and surface_maximum is 0 or at least the minimum.
void check_options(const SizingOptions& options);

/// One build of a field by all ranks, the same on each and for any number of them. A source asks for its size
/// in the whole cell around it whose edge is at most that size; elsewhere the size is that of the cheapest
/// source, size + ln(growth) * distance from that cell. The root is shared as pages: a rank has the sources
/// and makes the leaves in its own. Sizes at corners of leaves are found by ranges of the Morton curve. What
/// is looked up everywhere, leaves, the cells of sources, is held once per node.
class FieldBuilder {
public:
  /// Collective, as all that follows.
  FieldBuilder(const parallel::Communicator& communicator, const geometry::Box& domain,
               const SizingOptions& options);
  /// Starts from a field of these ranks that the new one must nowhere exceed.
  explicit FieldBuilder(const SizeField& previous);

  /// The field under the sources of all ranks, whose sizes may lie below the minimum. Called once.
  SizeField build(std::vector<SizeSource> sources);
  /// Builds the field; nothing, at less cost, where the field has clearly more than `most_leaves`.
  std::optional<SizeField> build_within(std::vector<SizeSource> sources, std::int64_t most_leaves);

private:
  /// A source's cell.
  struct Cell {
    std::uint64_t key;  ///< of its low corner
    int level;
  };
  /// A point of the finest grid, by its key, with a size asked for there.
  struct PointSize {
    std::uint64_t key;
    double size;

    static constexpr auto fields() { return std::tuple(&PointSize::key, &PointSize::size); }
    friend auto operator<=>(const PointSize&, const PointSize&) = default;
  };
  Cell cell_of(const SizeSource& source) const;
  /// Throws std::invalid_argument on all ranks where one has an impossible source.
  void require_positive(std::span<const SizeSource> own) const;
  /// The root in pages, by these sources, or by the leaves of the field it starts from.
  Pages divide_root(std::span<const SizeSource> own) const;
  /// Gives sources to the ranks in whose pages their cells begin; of those of one cell the smallest is kept.
  std::vector<SizeSource> send_to_pages(const Pages& pages, std::vector<SizeSource> own) const;
  void split_at_sources();
  /// As the field that it starts from is.
  void split_as_before();
  std::vector<SizeSeed> seeds_at_sources() const;
  /// Keeps the smallest of the sizes at one point; points along the curve.
  static void keep_smallest(std::vector<PointSize>& sizes);
  /// Corners that hanging corners of leaves hang on, with the smallest size that the sources of this rank ask
  /// for in those leaves.
  std::vector<PointSize> sizes_at_masters(const Octree& octree) const;
  /// The tree of the sources' cells, given, and of those.
  SeedTree plant_seeds(const Octree& octree, const SharedSeeds& at_sources) const;
  Octree grow_octree() const;
  /// False where that would take more cubes than that.
  bool split_where_coarse(const SeedTree& seeds, std::int64_t most_cubes);
  /// The bound that no size may exceed at a point.
  double bound_at(GridPoint p) const;
  std::vector<float> sizes_at_corners(const Octree& octree, const SeedTree& seeds, IndexRange range) const;
  /// With the sizes at corners of this rank's leaves as they are held.
  SizeField finish(const Octree& octree, std::vector<float> own_sizes) const;

  parallel::Communicator _communicator;
  geometry::Box _domain;
  SizingOptions _options;
  const SizeField* _previous = nullptr;
  RootCube _root;
  double _slope;  ///< in size per finest cell
  SplitCubes _cells;
  std::vector<SizeSource> _sources;
};

}  // namespace aeroloom::sizing
