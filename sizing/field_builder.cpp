#include "sizing/field_builder.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::sizing {
namespace {

/// Edge of a leaf over the size at its centre, at most, where no source lies in it: there h is a cone or a
/// plane, which trilinear interpolation follows within a few percent.
constexpr double leaf_edge_per_size = 2.0;

void require(bool holds, const char* what, double value) {
  if (!holds) throw std::invalid_argument(fmt::format("sizing: {}, but it is {}", what, value));
}

/// Rounds up, so that a float never falls below the bound its double kept.
float round_up(double value) {
  const auto rounded = static_cast<float>(value);
  return rounded < value ? std::nextafter(rounded, std::numeric_limits<float>::infinity()) : rounded;
}

/// The nodes the front has still to leave, in buckets of about a tenth in size; within a bucket in the order
/// they came, so that neighbours in memory mostly stay together. A node whose size falls again simply comes
/// again.
class Front {
public:
  void push(double size, std::int32_t node) {
    const std::uint64_t i = bucket(size);
    if (_buckets.empty()) _buckets.resize(1), _first = i;
    if (i < _first) {
      _buckets.insert(_buckets.begin(), _first - i, {});
      _first = i;
    } else if (i - _first >= _buckets.size()) {
      _buckets.resize(i - _first + 1);
    }
    _buckets[i - _first].push_back({size, node});
  }

  /// Calls leave(size, node) for all, ascending by bucket; it may push sizes that are no smaller than its
  /// own.
  template <class Leave>
  void run(const Leave& leave) {
    for (std::size_t b = 0; b < _buckets.size(); ++b) {
      for (std::size_t i = 0; i < _buckets[b].size(); ++i) {
        const Entry entry = _buckets[b][i];
        leave(entry.size, entry.node);
      }
      _buckets[b] = {};
    }
  }

private:
  struct Entry {
    double size;
    std::int32_t node;
  };

  /// Exponent and three bits of the mantissa: ascending with the (positive) size.
  static std::uint64_t bucket(double size) { return std::bit_cast<std::uint64_t>(size) >> 49; }

  std::uint64_t _first = 0;
  std::vector<std::vector<Entry>> _buckets;
};

}  // namespace

void check_options(const SizingOptions& options) {
  require(options.minimum > 0 && std::isfinite(options.minimum), "minimum must be positive", options.minimum);
  require(options.maximum >= options.minimum && std::isfinite(options.maximum),
          "maximum must not be below minimum", options.maximum);
  require(options.growth > 1 && options.growth <= largest_growth, "growth must lie in (1, 10]",
          options.growth);
  require(options.curvature_angle > 0 && options.curvature_angle < 180,
          "curvature_angle must lie in (0, 180)", options.curvature_angle);
  require(options.chordal_deviation >= 0, "chordal_deviation must not be negative",
          options.chordal_deviation);
  require(options.surface_maximum == 0 || options.surface_maximum >= options.minimum,
          "surface_maximum must be 0 or at least minimum", options.surface_maximum);
}

FieldBuilder::FieldBuilder(const geometry::Box& domain, const SizingOptions& options)
    : _domain(domain), _options(options), _root(domain), _slope(std::log(options.growth)) {
  check_options(options);
  require(!domain.empty() && _root.edge > 0 && std::isfinite(_root.edge), "the domain must not be empty",
          domain.diagonal());
}

FieldBuilder::FieldBuilder(const SizeField& previous) : FieldBuilder(previous._domain, previous._options) {
  _previous = &previous;
  for (std::size_t leaf = 0; leaf < previous._leaf_keys.size(); ++leaf) {
    if (previous._leaf_levels[leaf] > 0)
      _cells.split(previous._leaf_keys[leaf], previous._leaf_levels[leaf] - 1);
  }
}

SizeField FieldBuilder::build(std::span<const SizeSource> sources) {
  return *build_within(sources, std::numeric_limits<std::int64_t>::max());
}

std::optional<SizeField> FieldBuilder::build_within(std::span<const SizeSource> sources,
                                                    std::int64_t most_leaves) {
  for (const SizeSource& source : sources) {
    require(source.size > 0 && std::isfinite(source.size), "a source must have a positive size", source.size);
    if (source.size < _options.maximum) _sources.push_back(source);
  }
  _sources = thin_sources(_root, _sources);
  split_at_sources();
  _cells.balance();
  if (_cells.leaf_count() > most_leaves) return std::nullopt;
  if (!split_where_coarse(solve(), most_leaves / 8)) return std::nullopt;
  return finish(solve());
}

void FieldBuilder::split_at_sources() {
  for (const SizeSource& source : _sources) {
    const std::uint64_t key = morton_key(_root.cell(source.point));
    const int level = _root.level(source.size);
    if (level > 0) _cells.split(key, level - 1);
  }
}

FieldBuilder::Sizes FieldBuilder::solve() {
  _cells.balance();
  Sizes sizes;
  sizes.leaves = _cells.leaves();
  sizes.table = LeafTable(sizes.leaves);
  sizes.nodes = collect_nodes(sizes.leaves, sizes.table);
  bound_sizes(sizes);
  plant_seeds(sizes);
  run_front(sizes);
  return sizes;
}

void FieldBuilder::bound_sizes(Sizes& sizes) const {
  sizes.size.assign(sizes.nodes.points.size(), _options.maximum);
  if (_previous == nullptr) return;
  const double unit = _root.edge / grid_size;
  for (std::size_t n = 0; n < sizes.size.size(); ++n) {
    const GridPoint p = sizes.nodes.points[n];
    sizes.size[n] = _previous->interpolate(unit * p.x, unit * p.y, unit * p.z);
  }
}

void FieldBuilder::plant_seeds(Sizes& sizes) const {
  sizes.seed_size.assign(sizes.nodes.points.size(), _options.maximum);
  for (const SizeSource& source : _sources) {
    const std::int32_t leaf = sizes.table.find(morton_key(_root.cell(source.point)));
    for (int corner = 0; corner < 8; ++corner) {
      double& size = sizes.seed_size[sizes.nodes.corners[8 * static_cast<std::size_t>(leaf) + corner]];
      size = std::min(size, source.size);
    }
  }
  // A hanging node takes the mean of its masters in the end: they must ask for its size too.
  for (const OctreeNodes::Hanging& hanging : sizes.nodes.hanging) {
    for (int i = 0; i < hanging.count; ++i) {
      double& size = sizes.seed_size[hanging.masters[i]];
      size = std::min(size, sizes.seed_size[hanging.node]);
    }
  }
}

double FieldBuilder::distance(GridPoint a, GridPoint b) const {
  const double dx = static_cast<double>(a.x) - b.x, dy = static_cast<double>(a.y) - b.y,
               dz = static_cast<double>(a.z) - b.z;
  return std::sqrt(dx * dx + dy * dy + dz * dz) * (_root.edge / grid_size);
}

void FieldBuilder::run_front(Sizes& sizes) const {
  const OctreeNodes& nodes = sizes.nodes;
  sizes.seed.assign(nodes.points.size(), -1);
  Front front;
  for (std::size_t n = 0; n < nodes.points.size(); ++n) {
    if (sizes.seed_size[n] >= sizes.size[n]) continue;
    sizes.size[n] = sizes.seed_size[n];
    sizes.seed[n] = static_cast<std::int32_t>(n);
    front.push(sizes.size[n], static_cast<std::int32_t>(n));
  }
  front.run([&](double size, std::int32_t node) {
    if (size > sizes.size[node]) return;
    const std::int32_t seed = sizes.seed[node];
    const double seed_size = sizes.seed_size[seed];
    const GridPoint seed_point = nodes.points[seed];
    const std::int32_t* around = nodes.leaf_around.data() + 8 * static_cast<std::size_t>(node);
    for (int octant = 0; octant < 8; ++octant) {
      if (around[octant] < 0 || (octant > 0 && around[octant] == around[octant - 1])) continue;
      const std::int32_t* corners = nodes.corners.data() + 8 * static_cast<std::size_t>(around[octant]);
      for (int corner = 0; corner < 8; ++corner) {
        const std::int32_t other = corners[corner];
        if (sizes.size[other] <= size) continue;
        const double offer = seed_size + _slope * distance(seed_point, nodes.points[other]);
        if (offer >= sizes.size[other]) continue;
        sizes.size[other] = offer;
        sizes.seed[other] = seed;
        front.push(offer, other);
      }
    }
  });
}

bool FieldBuilder::split_where_coarse(const Sizes& sizes, std::int64_t most_cubes) {
  std::array<std::int32_t, 8> seeds{};
  std::int64_t split = 0;
  const auto visit = [&](auto&& self, std::uint64_t key, int level) -> void {
    const std::uint32_t half = grid_size >> level >> 1;
    const GridPoint low = grid_point(key), center{low.x + half, low.y + half, low.z + half};
    double size = _options.maximum;
    for (const std::int32_t seed : seeds) {
      if (seed >= 0)
        size = std::min(size, sizes.seed_size[seed] + _slope * distance(sizes.nodes.points[seed], center));
    }
    if (level >= finest_level || std::ldexp(_root.edge, -level) <= leaf_edge_per_size * size) return;
    if (++split > most_cubes) return;
    _cells.split(key, level);
    for (std::uint64_t child = 0; child < 8; ++child) {
      self(self, key | child << 3 * (finest_level - level - 1), level + 1);
    }
  };
  for (std::size_t leaf = 0; leaf < sizes.leaves.keys.size(); ++leaf) {
    for (int corner = 0; corner < 8; ++corner)
      seeds[corner] = sizes.seed[sizes.nodes.corners[8 * leaf + corner]];
    // Without a seed the leaf lies at the maximum, or where the previous field rules.
    if (std::all_of(seeds.begin(), seeds.end(), [](std::int32_t seed) { return seed < 0; })) continue;
    visit(visit, sizes.leaves.keys[leaf], sizes.leaves.levels[leaf]);
    if (split > most_cubes) return false;
  }
  return true;
}

SizeField FieldBuilder::finish(Sizes sizes) const {
  for (const OctreeNodes::Hanging& hanging : sizes.nodes.hanging) {
    double sum = 0;
    for (int i = 0; i < hanging.count; ++i) sum += sizes.size[hanging.masters[i]];
    sizes.size[hanging.node] = sum / hanging.count;
  }
  SizeField field;
  field._options = _options;
  field._domain = _domain;
  field._low = _root.low;
  field._root_edge = _root.edge;
  field._corner_sizes.reserve(sizes.nodes.corners.size());
  for (const std::int32_t node : sizes.nodes.corners)
    field._corner_sizes.push_back(round_up(sizes.size[node]));
  field._leaf_keys = std::move(sizes.leaves.keys);
  field._leaf_levels = std::move(sizes.leaves.levels);
  field._leaf_table = std::move(sizes.table);
  return field;
}

}  // namespace aeroloom::sizing
