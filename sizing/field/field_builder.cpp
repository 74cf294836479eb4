#include "sizing/field/field_builder.hpp"

#include "geometry/sort_by_key.hpp"
#include "geometry/sort_unique.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/communication/deliver.hpp"
#include "parallel/observation/timers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::sizing {

using parallel::ScopedCpu;

namespace {

/// Edge of a leaf over the size at its centre, at most, where no source lies in it: there h is a cone or a
/// plane, which trilinear interpolation follows within a few percent.
constexpr double leaf_edge_per_size = 2.0;
/// Leaves before the division of coarse ones over the most there may be: a division makes eight of one.
constexpr std::int64_t growth_by_division = 8;
/// More sources, or leaves of the field to start from, are shared by several subtrees; chosen, not measured.
constexpr std::int64_t cells_per_subtree = 500;
/// Masters are not looked through for equal ones before there are so many: to do so takes a sort of all.
/// Chosen, not measured.
constexpr std::size_t least_masters = 1 << 20;

void require(bool holds, const char* what, double value) {
  if (!holds) throw std::invalid_argument(fmt::format("sizing: {}, but it is {}", what, value));
}

/// Finest cells in a leaf of this level.
std::uint64_t cells_in_leaf(int level) {
  return 1ULL << 3 * (finest_level - level);
}

/// Rounds up, so that a float never falls below the bound its double kept.
float round_up(double value) {
  const auto rounded = static_cast<float>(value);
  return rounded < value ? std::nextafter(rounded, std::numeric_limits<float>::infinity()) : rounded;
}

}  // namespace

void check_options(const SizingOptions& options) {
  require(options.minimum > 0 && std::isfinite(options.minimum), "minimum must be positive", options.minimum);
  require(options.maximum >= options.minimum && std::isfinite(options.maximum),
          "maximum must not be below minimum", options.maximum);
  require(options.growth > 1 && options.growth <= largest_growth, "growth must lie in (1, 10]",
          options.growth);
  require(options.curvature_angle > 0 && options.curvature_angle < 180,
          "curvature_angle must lie in (0, 180)", options.curvature_angle);
  require(options.feature_aspect >= 1, "feature_aspect must be at least 1", options.feature_aspect);
  require(options.chordal_deviation >= 0, "chordal_deviation must not be negative",
          options.chordal_deviation);
  require(options.surface_maximum == 0 || options.surface_maximum >= options.minimum,
          "surface_maximum must be 0 or at least minimum", options.surface_maximum);
}

FieldBuilder::FieldBuilder(const parallel::Communicator& communicator, const geometry::Box& domain,
                           const SizingOptions& options)
    : _communicator(communicator),
      _domain(domain),
      _options(options),
      _root(domain),
      _slope(std::log(options.growth) * _root.edge / grid_size) {
  check_options(options);
  require(!domain.empty() && _root.edge > 0 && std::isfinite(_root.edge), "the domain must not be empty",
          domain.diagonal());
}

FieldBuilder::FieldBuilder(const SizeField& previous)
    : FieldBuilder(previous.communicator(), previous._domain, previous._options) {
  _previous = &previous;
}

SizeField FieldBuilder::build(std::vector<SizeSource> sources) {
  return *build_within(std::move(sources), std::numeric_limits<std::int64_t>::max());
}

std::optional<SizeField> FieldBuilder::build_within(std::vector<SizeSource> sources,
                                                    std::int64_t most_leaves) {
  require_positive(sources);
  std::erase_if(sources, [&](const SizeSource& source) { return source.size >= _options.maximum; });
  const ScopedCpu own(ScopedCpu::As::task);
  sources = thin_sources(_root, sources);
  _cells = SplitCubes(divide_root(sources));
  _sources = send_to_owners(_cells.subtrees(), std::move(sources));
  split_at_sources();
  if (_previous != nullptr) split_as_before();
  _cells.balance();
  if (_cells.leaf_count() > most_leaves) return std::nullopt;
  const SharedSeeds at_sources(_cells.subtrees(), seeds_at_sources());
  if (!split_where_coarse(SeedTree({&at_sources}, _slope), most_leaves / growth_by_division))
    return std::nullopt;
  _cells.balance();
  if (_cells.leaf_count() > std::numeric_limits<std::int32_t>::max())
    throw std::invalid_argument("sizing: the field would have more than 2^31 leaves. Remedy: larger sizes");
  const Octree octree = grow_octree();
  const SeedTree seeds = plant_seeds(octree, at_sources);
  std::vector<float> mine;
  parallel::agree(_communicator, [&] {
    const IndexRange own = CornerSizes::part_of(octree, _communicator.rank());
    mine = CornerSizes::pack(octree.leaves(), own, sizes_at_corners(octree, seeds, own));
  });
  return finish(octree, std::move(mine));
}

// Ranks have different sources: all must hear of one that is impossible.
void FieldBuilder::require_positive(std::span<const SizeSource> own) const {
  double smallest = std::numeric_limits<double>::infinity();
  for (const SizeSource& source : own)
    smallest = std::min(smallest, std::isfinite(source.size) ? source.size : 0);
  smallest = _communicator.minimum(smallest);
  require(smallest > 0, "a source must have a positive, finite size", smallest);
}

Subtrees FieldBuilder::divide_root(std::span<const SizeSource> own) const {
  if (_previous != nullptr) {
    const CellSpans leaves = _previous->_octree.leaves();
    const IndexRange own_leaves = even_part(leaves.size(), _communicator.rank(), _communicator.size());
    return {_communicator, leaves.part(own_leaves), cells_per_subtree};
  }
  std::vector<Cell> cells;
  for (const SizeSource& source : own) cells.push_back(cell_of(source));
  geometry::sort_by_key(cells, [](const Cell& cell) { return cell.key; });
  std::vector<std::uint64_t> keys;
  std::vector<std::uint8_t> levels;
  for (const Cell& cell : cells) {
    keys.push_back(cell.key);
    levels.push_back(static_cast<std::uint8_t>(cell.level));
  }
  return {_communicator, {keys, levels}, cells_per_subtree};
}

std::vector<SizeSource> FieldBuilder::send_to_owners(const Subtrees& subtrees,
                                                     std::vector<SizeSource> own) const {
  const auto owner = [&](const SizeSource& source) {
    return subtrees.owner(subtrees.find(cell_of(source).key));
  };
  return thin_sources(_root, parallel::deliver(_communicator, std::move(own), owner));
}

FieldBuilder::Cell FieldBuilder::cell_of(const SizeSource& source) const {
  const int level = _root.level(source.size), below = 3 * (finest_level - level);
  return {morton_key(_root.cell(source.point)) >> below << below, level};
}

void FieldBuilder::split_at_sources() {
  for (const SizeSource& source : _sources) {
    const Cell cell = cell_of(source);
    if (cell.level > 0) _cells.split(cell.key, cell.level - 1);
  }
}

void FieldBuilder::split_as_before() {
  const auto [keys, levels] = _previous->_octree.leaves();
  const IndexRange own = _cells.own_subtrees();
  if (own.size() == 0) return;
  const Subtrees& subtrees = _cells.subtrees();
  const auto first = std::lower_bound(keys.begin(), keys.end(), subtrees.key(own.first));
  const auto last =
      own.last < subtrees.count() ? std::lower_bound(first, keys.end(), subtrees.key(own.last)) : keys.end();
  for (auto key = first; key < last; ++key) {
    const int level = levels[static_cast<std::size_t>(key - keys.begin())];
    if (level > 0) _cells.split(*key, level - 1);
  }
}

std::vector<SizeSeed> FieldBuilder::seeds_at_sources() const {
  std::vector<SizeSeed> seeds;
  seeds.reserve(_sources.size());
  for (const SizeSource& source : _sources) {
    const Cell cell = cell_of(source);
    seeds.push_back({grid_point(cell.key), grid_size >> cell.level, source.size});
  }
  return seeds;
}

void FieldBuilder::keep_smallest(std::vector<PointSize>& sizes) {
  const auto same_point = [](const PointSize& a, const PointSize& b) { return a.key == b.key; };
  geometry::sort_unique(sizes, std::less<>(), same_point);
}

std::vector<FieldBuilder::PointSize> FieldBuilder::sizes_at_masters(const Octree& octree) const {
  std::vector<PointSize> at_masters;
  std::size_t room = least_masters;
  for (const SizeSource& source : _sources) {
    const Cell cell = cell_of(source);
    const std::int32_t leaf = octree.table.find(cell.key);
    if (octree.levels[leaf] != cell.level) continue;  // of smaller leaves none hangs outside the cell
    for (const GridPoint master : masters_of_corners(octree.leaves(), octree.table, leaf))
      at_masters.push_back({morton_key(master), source.size});
    if (at_masters.size() <= room) continue;
    keep_smallest(at_masters);
    room = std::max(least_masters, 2 * at_masters.size());
  }
  keep_smallest(at_masters);
  return at_masters;
}

// A hanging node takes the mean of its masters in the end: where a source asks for its size they must, too.
SeedTree FieldBuilder::plant_seeds(const Octree& octree, const SharedSeeds& at_sources) const {
  std::vector<PointSize> at_masters;
  parallel::agree(_communicator, [&] { at_masters = sizes_at_masters(octree); });
  const Subtrees& subtrees = _cells.subtrees();
  const auto owner = [&](const PointSize& at) { return subtrees.owner(subtrees.find(at.key)); };
  at_masters = parallel::deliver(_communicator, std::move(at_masters), owner);
  keep_smallest(at_masters);
  std::vector<SizeSeed> seeds;
  seeds.reserve(at_masters.size());
  for (const PointSize& at : at_masters) seeds.push_back({grid_point(at.key), 0, at.size});
  const SharedSeeds shared(subtrees, seeds);
  return SeedTree({&at_sources, &shared}, _slope);
}

Octree FieldBuilder::grow_octree() const {
  const SplitCubes::Leaves own = _cells.leaves();
  Octree octree{_communicator, {}, {}, {}};
  octree.levels = parallel::NodeArray<std::uint8_t>::gathered(_communicator, own.levels);
  // Keys and table follow from the levels.
  const auto write_keys = [&](parallel::Rank rank, std::size_t first, std::span<std::uint64_t> to) {
    std::uint64_t next = _cells.subtrees().first_key(rank);
    for (std::uint64_t& key : to) {
      key = next;
      next += cells_in_leaf(octree.levels[first++]);
    }
  };
  octree.keys = parallel::NodeArray<std::uint64_t>::composed(_communicator, own.keys, write_keys);
  octree.table = LeafTable(_cells.subtrees(), own, octree.leaves());
  return octree;
}

double FieldBuilder::bound_at(GridPoint p) const {
  if (_previous == nullptr) return _options.maximum;
  const double unit = _root.edge / grid_size;
  return _previous->interpolate(unit * p.x, unit * p.y, unit * p.z);
}

bool FieldBuilder::split_where_coarse(const SeedTree& seeds, std::int64_t most_cubes) {
  std::int64_t count = 0;
  const auto visit = [&](auto&& self, std::uint64_t key, int level) -> void {
    if (level >= finest_level || count > most_cubes) return;
    const std::uint32_t half = grid_size >> level >> 1;
    const GridPoint low = grid_point(key), center{low.x + half, low.y + half, low.z + half};
    const double too_small = std::ldexp(_root.edge, -level) / leaf_edge_per_size;
    if (!seeds.offers_less(center, std::min(too_small, bound_at(center)))) return;
    _cells.split(key, level);
    ++count;
    for (std::uint64_t child = 0; child < 8; ++child)
      self(self, key | child << 3 * (finest_level - level - 1), level + 1);
  };
  parallel::agree(_communicator, [&] {
    const SplitCubes::Leaves leaves = _cells.leaves();
    for (std::size_t leaf = 0; leaf < leaves.keys.size(); ++leaf)
      visit(visit, leaves.keys[leaf], leaves.levels[leaf]);
  });
  return _communicator.sum(count) <= most_cubes;
}

std::vector<float> FieldBuilder::sizes_at_corners(const Octree& octree, const SeedTree& seeds,
                                                  IndexRange range) const {
  const OctreeNodes nodes = collect_nodes(octree.leaves(), octree.table, range);
  std::int32_t near = -1;
  const auto size_at = [&](GridPoint p) { return seeds.cheapest(p, bound_at(p), near); };
  std::vector<double> sizes(nodes.points.size());
  auto next = nodes.hanging.begin();
  for (std::size_t n = 0; n < nodes.points.size(); ++n) {
    if (next != nodes.hanging.end() && next->node == static_cast<std::int32_t>(n)) {
      ++next;
    } else {
      sizes[n] = size_at(nodes.points[n]);
    }
  }
  for (const OctreeNodes::Hanging& hanging : nodes.hanging) {
    double sum = 0;
    for (int i = 0; i < hanging.count; ++i) {
      const std::int32_t node = hanging.master_nodes[i];
      sum += node >= 0 ? sizes[node] : size_at(hanging.masters[i]);
    }
    sizes[hanging.node] = sum / hanging.count;
  }
  std::vector<float> corner_sizes;
  corner_sizes.reserve(nodes.corners.size());
  for (const std::int32_t node : nodes.corners) corner_sizes.push_back(round_up(sizes[node]));
  return corner_sizes;
}

SizeField FieldBuilder::finish(const Octree& octree, std::vector<float> own_sizes) const {
  SizeField field;
  field._options = _options;
  field._domain = _domain;
  field._low = _root.low;
  field._root_edge = _root.edge;
  field._corner_sizes = CornerSizes(octree, std::move(own_sizes));
  field._octree = octree;
  return field;
}

}  // namespace aeroloom::sizing
