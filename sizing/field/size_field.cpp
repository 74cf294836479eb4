#include "sizing/field/size_field.hpp"

#include "sizing/field/field_builder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace aeroloom::sizing {
namespace {

/// Finest cell along one axis; NaN counts as 0.
std::uint32_t cell_of(double t) {
  if (!(t > 0)) return 0;
  return t < grid_size - 1 ? static_cast<std::uint32_t>(t) : grid_size - 1;
}

/// Position within the leaf of the given edge (in finest cells) along one axis, 0 to 1.
double fraction(double t, std::uint32_t cell, std::uint32_t leaf_edge) {
  const double low = cell & ~(leaf_edge - 1);
  return std::clamp((t - low) / leaf_edge, 0.0, 1.0);
}

/// Those of the options that are lengths.
constexpr std::array lengths{&SizingOptions::minimum,          &SizingOptions::maximum,
                             &SizingOptions::surface_maximum,  &SizingOptions::feature_minimum,
                             &SizingOptions::narrow_minimum,   &SizingOptions::gap_minimum,
                             &SizingOptions::chordal_deviation};

double blend(double a, double b, double t) {
  return a + t * (b - a);
}

}  // namespace

SizeField SizeField::build(const geometry::Box& domain, std::span<const SizeSource> sources,
                           const SizingOptions& options) {
  std::vector<SizeSource> bounded(sources.begin(), sources.end());
  for (SizeSource& source : bounded) {
    if (source.size > 0) source.size = std::max(source.size, options.minimum);
  }
  return FieldBuilder(parallel::Communicator::self(), domain, options).build(std::move(bounded));
}

SizeField SizeField::refined(std::span<const SizeSource> more) const {
  return FieldBuilder(*this).build({more.begin(), more.end()});
}

double SizeField::operator()(geometry::Vec3 x) const {
  return interpolate(std::clamp(x.x, _domain.low.x, _domain.high.x) - _low.x,
                     std::clamp(x.y, _domain.low.y, _domain.high.y) - _low.y,
                     std::clamp(x.z, _domain.low.z, _domain.high.z) - _low.z);
}

double SizeField::interpolate(double dx, double dy, double dz) const {
  const double cells_per_length = grid_size / _root_edge;
  const double tx = dx * cells_per_length, ty = dy * cells_per_length, tz = dz * cells_per_length;
  const GridPoint cell{cell_of(tx), cell_of(ty), cell_of(tz)};
  const auto leaf = static_cast<std::size_t>(_octree.table.find(morton_key(cell)));
  const std::uint32_t edge = grid_size >> _octree.levels[leaf];
  const double u = fraction(tx, cell.x, edge), v = fraction(ty, cell.y, edge), w = fraction(tz, cell.z, edge);
  const CornerSizes::Cube h = _corner_sizes.of_leaf(leaf);
  const double low = blend(blend(h(0), h(1), u), blend(h(2), h(3), u), v);
  const double high = blend(blend(h(4), h(5), u), blend(h(6), h(7), u), v);
  return std::min(_factor * blend(low, high, w), _options.maximum);
}

SizeField SizeField::scaled(double factor) const {
  SizeField result = *this;
  for (double SizingOptions::*length : lengths) result._options.*length *= factor;
  // Sizes grow by as much more for each length.
  result._options.growth = std::pow(_options.growth, factor);
  result._factor *= factor;
  return result;
}

SizeField::Leaf SizeField::leaf(std::int64_t i) const {
  const GridPoint low = grid_point(_octree.keys[i]);
  const double unit = _root_edge / grid_size;
  const CornerSizes::Cube h = _corner_sizes.of_leaf(i);
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) sum += h(corner);
  return {_low + unit * geometry::Vec3{double(low.x), double(low.y), double(low.z)},
          unit * (grid_size >> _octree.levels[i]), std::min(_factor * sum / 8, _options.maximum)};
}

SizeField::Leaf SizeField::ancestor(std::int64_t i, int levels) const {
  const int level = std::max(0, _octree.levels[i] - levels);
  const std::uint32_t edge = grid_size >> level, mask = ~(edge - 1);
  const GridPoint low = grid_point(_octree.keys[i]);
  const double unit = _root_edge / grid_size;
  return {_low + unit * geometry::Vec3{double(low.x & mask), double(low.y & mask), double(low.z & mask)},
          unit * edge, 0};
}

}  // namespace aeroloom::sizing
