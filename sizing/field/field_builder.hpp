/// Builds size fields: the octree, the sizes at its corners, and the hanging corners.
#pragma once

#include "sizing/field/seed_tree.hpp"
#include "sizing/field/size_field.hpp"
#include "sizing/field/sources.hpp"

#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace aeroloom::sizing {

/// The largest growth ratio of neighbouring sizes that is accepted.
inline constexpr double largest_growth = 10;

/// Throws std::invalid_argument, naming the option, unless 0 < minimum <= maximum, growth > 1,
/// 0 < curvature_angle < 180 and surface_maximum is 0 or at least the minimum.
void check_options(const SizingOptions& options);

/// Builds one field on all ranks. The result is the same on every rank and for any number of ranks. A source
/// asks for its size in the whole cell around it whose edge is at most that size. Elsewhere the size is the
/// least of size + ln(growth) * distance from that cell, over all sources. Each rank makes the leaves in its
/// own subtrees of the octree. Sizes at corners are found by ranges of the Morton curve. Leaves and seeds are
/// needed everywhere and held once on each node.
class FieldBuilder {
public:
  /// Collective, as all that follows.
  FieldBuilder(const parallel::Communicator& communicator, const geometry::Box& domain,
               const SizingOptions& options);
  /// Starts from a field of the same ranks. The new field exceeds it nowhere.
  explicit FieldBuilder(const SizeField& previous);

  /// The field of the sources of all ranks. Their sizes may lie below the minimum. Call it once.
  SizeField build(std::vector<SizeSource> sources);
  /// As build(), but returns nothing if the field would clearly have more than `most_leaves` leaves. That
  /// costs less than the field.
  std::optional<SizeField> build_within(std::vector<SizeSource> sources, std::int64_t most_leaves);

private:
  /// The cell around a source.
  struct Cell {
    std::uint64_t key;  ///< of its low corner
    int level;
  };
  /// A point of the finest grid, given by its key, and a size asked for there.
  struct PointSize {
    std::uint64_t key;
    double size;
    friend auto operator<=>(const PointSize&, const PointSize&) = default;
  };
  Cell cell_of(const SizeSource& source) const;
  /// Throws std::invalid_argument on all ranks where one has an impossible source.
  void require_positive(std::span<const SizeSource> own) const;
  /// Divides the root into subtrees, by these sources or by the leaves of the field to start from.
  Subtrees divide_root(std::span<const SizeSource> own) const;
  /// Sends each source to the rank that owns the subtree where its cell begins. Of the sources in one cell
  /// the smallest is kept.
  std::vector<SizeSource> send_to_owners(const Subtrees& subtrees, std::vector<SizeSource> own) const;
  void split_at_sources();
  /// Splits cells as in the field to start from.
  void split_as_before();
  std::vector<SizeSeed> seeds_at_sources() const;
  /// Keeps the smallest of the sizes at each point; sorts points along the Morton curve.
  static void keep_smallest(std::vector<PointSize>& sizes);
  /// The masters of hanging corners of the leaves in which sources of this rank lie. Each has the smallest
  /// size that those sources ask for.
  std::vector<PointSize> sizes_at_masters(const Octree& octree) const;
  /// The tree of the seeds at sources, and of seeds at masters of hanging corners.
  SeedTree plant_seeds(const Octree& octree, const SharedSeeds& at_sources) const;
  Octree grow_octree() const;
  /// Returns false where it would split more than `most_cubes` cubes.
  bool split_where_coarse(const SeedTree& seeds, std::int64_t most_cubes);
  /// The largest size allowed at a point.
  double bound_at(GridPoint p) const;
  std::vector<float> sizes_at_corners(const Octree& octree, const SeedTree& seeds, IndexRange range) const;
  /// `own_sizes`: the packed sizes at corners of the leaves of this rank.
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
