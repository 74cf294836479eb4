#include "layers/layer_validity.hpp"

#include "geometry/predicates.hpp"
#include "mesh/quality/cell_measures.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace aeroloom::layers {
namespace {

using geometry::has_positive_volume;
using geometry::Vec3;

using Level = std::array<Vec3, 3>;

constexpr double kept_jacobian = 0.5;  // of the scaled Jacobian at vanishing height
constexpr double kept_angle = 0.6;     // of the wall triangle's smallest angle

/// Twice the area of a triangle along its normal.
Vec3 doubled_area(const Level& level) {
  return cross(level[1] - level[0], level[2] - level[0]);
}

/// At least the sum of absolute components of any vector between two of the six nodes.
double extent(const Level& q, const Level& t) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low, high] =
        std::minmax({q[0][axis], q[1][axis], q[2][axis], t[0][axis], t[1][axis], t[2][axis]});
    sum += high - low;
  }
  return sum;
}

/// Whether all twelve corner tetrahedra are positive beyond rounding errors. Their determinants share normals
/// of triangles and of halves of lateral faces.
bool is_clearly_positive(const Level& q, const Level& t, Vec3 below, Vec3 above) {
  constexpr double beyond_rounding = 1e-14;
  const double size = extent(q, t);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) least = std::min({least, dot(below, t[i] - q[0]), dot(above, t[0] - q[i])});
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const Vec3 side = q[i] - q[j], at_j = cross(side, t[j] - q[j]), at_i = cross(side, t[i] - q[i]);
    least = std::min({least, dot(at_j, t[k] - q[j]), dot(at_i, t[k] - q[j])});
  }
  return least > beyond_rounding * size * size * size;
}

/// `below` and `above` are the normals of the triangles.
bool is_good_prism(const Level& q, const Level& t, Vec3 below, Vec3 above) {
  if (is_clearly_positive(q, t, below, above)) return true;
  for (int i = 0; i < 3; ++i) {
    if (!has_positive_volume(q[0], q[1], q[2], t[i]) || !has_positive_volume(t[0], t[2], t[1], q[i]))
      return false;
  }
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    if (!has_positive_volume(q[j], q[i], t[j], t[k]) || !has_positive_volume(q[j], q[i], t[i], t[k]))
      return false;
  }
  return true;
}

/// Columns i and the next one are live, the third is not.
bool is_good_pyramid(const Level& q, const Level& t, int i) {
  const int j = (i + 1) % 3;
  const Vec3 apex = q[(i + 2) % 3];
  return has_positive_volume(q[j], q[i], t[j], apex) && has_positive_volume(q[j], q[i], t[i], apex) &&
         has_positive_volume(q[i], t[i], t[j], apex) && has_positive_volume(q[j], t[i], t[j], apex);
}

/// The smallest determinant of unit vectors at the corners of a triangle: along its sides and the column.
double corner_determinant(const Level& level, Vec3 normal, const Level& directions) {
  const double sides[3] = {distance(level[0], level[1]), distance(level[1], level[2]),
                           distance(level[2], level[0])};
  double least = 1;
  for (int i = 0; i < 3; ++i) {
    const double area = sides[i] * sides[(i + 2) % 3];
    least = std::min(least, area > 0 ? dot(normal, directions[i]) / area : 0);
  }
  return least;
}

/// The largest cosine of a triangle's angles; of a degenerate one, 1.
double largest_cosine(const Level& level) {
  double largest = -1;
  for (int i = 0; i < 3; ++i) {
    const Vec3 u = level[(i + 1) % 3] - level[i], w = level[(i + 2) % 3] - level[i];
    const double lengths = norm(u) * norm(w);
    largest = std::max(largest, lengths > 0 ? dot(u, w) / lengths : 1.0);
  }
  return std::min(largest, 1.0);
}

/// The directions of columns at heights.
Level directions_at(const TriangleColumns& columns, const std::array<double, 3>& heights) {
  Level directions;
  for (int i = 0; i < 3; ++i) directions[i] = columns[i].direction_at(heights[i]);
  return directions;
}

template <std::size_t N>
bool are_straight(const std::array<CornerColumn, N>& columns) {
  return std::all_of(columns.begin(), columns.end(), [](const CornerColumn& c) { return c.is_straight(); });
}

/// The nodes of columns layer by layer. Nearly all columns are straight, which is asked beforehand.
template <std::size_t N, bool straight>
class Levels {
public:
  explicit Levels(const std::array<CornerColumn, N>& columns) : _columns(columns) {
    for (std::size_t i = 0; i < N; ++i) {
      _level[i] = columns[i].point;
      _layers[i] = columns[i].heights.first;
    }
  }
  const std::array<Vec3, N>& level() const { return _level; }
  const std::array<double, N>& heights() const { return _sums; }
  /// Goes up by one layer; columns that end here stay.
  void advance() {
    ++_k;
    for (std::size_t i = 0; i < N; ++i) {
      const CornerColumn& column = _columns[i];
      if (_k > column.count) continue;
      if (_k > column.heights.constant) _layers[i] *= column.heights.growth;
      if (_k > column.heights.regular) _layers[i] *= column.heights.stretch;
      _sums[i] += _layers[i];
      if constexpr (straight) {
        _level[i] = column.point + _sums[i] * column.direction;
      } else {
        _level[i] = column.at(_sums[i]);
      }
    }
  }

private:
  const std::array<CornerColumn, N>& _columns;
  std::array<Vec3, N> _level;
  std::array<double, N> _layers{}, _sums{};
  std::int32_t _k = 0;
};

/// Whether the cell of layer k between two levels is good, by the columns that continue there.
bool is_good_cell(const TriangleColumns& columns, std::int32_t k, const Level& lower, const Level& upper,
                  Vec3 below, Vec3 above) {
  const bool live[3] = {columns[0].count >= k, columns[1].count >= k, columns[2].count >= k};
  const int count = live[0] + live[1] + live[2];
  if (count == 3) return is_good_prism(lower, upper, below, above);
  if (count == 2) return is_good_pyramid(lower, upper, !live[2] ? 0 : !live[0] ? 1 : 2);
  const int alone = live[0] ? 0 : live[1] ? 1 : 2;
  return has_positive_volume(lower[0], lower[1], lower[2], upper[alone]);
}

/// Bounds for cells, taken from the wall triangle.
struct Least {
  double determinant, cosine;

  explicit Least(const TriangleColumns& columns) {
    const Level wall{columns[0].point, columns[1].point, columns[2].point};
    determinant = kept_jacobian * corner_determinant(wall, doubled_area(wall), directions_at(columns, {}));
    cosine = std::cos(kept_angle * std::acos(largest_cosine(wall)));
  }
};

/// The heights of the columns' ends, and of the uppermost prism.
struct Ends {
  std::array<double, 3> totals, of_prisms;

  explicit Ends(const TriangleColumns& columns) {
    const std::int32_t prisms = std::min({columns[0].count, columns[1].count, columns[2].count});
    for (int i = 0; i < 3; ++i) {
      totals[i] = columns[i].heights.total(columns[i].count);
      of_prisms[i] = columns[i].count == prisms ? totals[i] : columns[i].heights.total(prisms);
    }
  }
  double highest() const { return std::max({totals[0], totals[1], totals[2]}); }
};

/// Whether cap and uppermost prism are good where all columns shrink to a height.
bool is_good_below(const TriangleColumns& columns, const Ends& ends, const Least& least, double height) {
  Level cap, prism;
  std::array<double, 3> heights;
  for (int i = 0; i < 3; ++i) {
    const double ratio = ends.totals[i] > height ? height / ends.totals[i] : 1;
    cap[i] = columns[i].at(ratio * ends.totals[i]);
    heights[i] = ratio * ends.of_prisms[i];
    prism[i] = columns[i].at(heights[i]);
  }
  return largest_cosine(cap) <= least.cosine &&
         corner_determinant(prism, doubled_area(prism), directions_at(columns, heights)) >= least.determinant;
}

template <bool straight>
std::int32_t count_good_layers(const TriangleColumns& columns) {
  const std::int32_t most = std::max({columns[0].count, columns[1].count, columns[2].count});
  const std::int32_t prisms = std::min({columns[0].count, columns[1].count, columns[2].count});
  const Least least(columns);
  const Level at_wall = directions_at(columns, {});
  Levels<3, straight> levels(columns);
  Level lower = levels.level();
  Vec3 below = doubled_area(lower);
  for (std::int32_t k = 1; k <= most; ++k) {
    levels.advance();
    const Level& upper = levels.level();
    const Vec3 above = doubled_area(upper);
    if (!is_good_cell(columns, k, lower, upper, below, above)) return k - 1;
    const auto determinant = [&] {
      if constexpr (straight) return corner_determinant(upper, above, at_wall);
      return corner_determinant(upper, above, directions_at(columns, levels.heights()));
    };
    if (k <= prisms && determinant() < least.determinant) return k - 1;
    lower = upper;
    below = above;
  }
  return most;
}

}  // namespace

std::int32_t good_layers(const TriangleColumns& columns) {
  return are_straight(columns) ? count_good_layers<true>(columns) : count_good_layers<false>(columns);
}

bool has_good_cap(const TriangleColumns& columns) {
  return is_good_below(columns, Ends(columns), Least(columns), std::numeric_limits<double>::infinity());
}

double fitting_height(const TriangleColumns& columns) {
  constexpr double step = 0.95;  // between heights that are tried; chosen, not measured
  // Of the highest column. Where counts differ, columns are fitted again before they fall further: then what
  // is bad may be how their last layers are stretched. Chosen, not measured.
  constexpr double lowest = 0.01, lowest_of_unequal = 0.8;
  const bool equal = columns[0].count == columns[1].count && columns[0].count == columns[2].count;
  const Ends ends(columns);
  const Least least(columns);
  const double highest = ends.highest(), floor = (equal ? lowest : lowest_of_unequal) * highest;
  if (!is_good_below(columns, ends, least, highest)) {
    double height = step * highest;
    while (height > floor && !is_good_below(columns, ends, least, height)) height *= step;
    return height;
  }
  const std::int32_t good = good_layers(columns);
  double below = 0;
  bool all = true, stretched = false;
  for (const CornerColumn& column : columns) {
    below = std::max(below, column.heights.total(std::min(good, column.count)));
    all = all && column.count <= good;
    stretched = stretched || good >= column.heights.regular;
  }
  if (all) return std::numeric_limits<double>::infinity();
  return std::clamp(below, stretched && !equal ? floor : 0, step * highest);
}

Vec3 sector_apex(const std::array<Vec3, 4>& top, const std::array<Vec3, 4>& directions) {
  constexpr double height = 0.4;  // over the root of the quadrilateral's area; chosen, not measured
  Vec3 middle, up;
  for (int i = 0; i < 4; ++i) middle += 0.25 * top[i], up += directions[i];
  const double area = 0.5 * norm(cross(top[2] - top[0], top[3] - top[1]));
  return middle + height * std::sqrt(area) * normalized(up);
}

namespace {

using FanLevel = std::array<Vec3, 4>;

/// Whether the cells of layer k between two levels are good.
bool is_good_layer(const LayersOverFan& over, std::int32_t k, const FanLevel& lower, const FanLevel& upper) {
  bool good = true;
  visit_layer(over, k, [&](mesh::CellShape shape, const auto& nodes) {
    std::array<Vec3, 8> points;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      points[i] = (nodes[i].level < k ? lower : upper)[static_cast<std::size_t>(nodes[i].corner)];
    if (shape == mesh::CellShape::prism) {
      const Level below{points[0], points[1], points[2]}, above{points[3], points[4], points[5]};
      good = good && is_good_prism(below, above, doubled_area(below), doubled_area(above));
    } else {
      good = good && mesh::has_positive_corners(shape, points.data());
    }
  });
  return good;
}

template <bool straight>
std::int32_t count_good_layers(const FanColumns& fan, std::int32_t most) {
  Levels<4, straight> levels(fan.columns);
  FanLevel lower = levels.level();
  for (std::int32_t k = 1; k <= most; ++k) {
    levels.advance();
    if (!is_good_layer(fan.over, k, lower, levels.level())) return k - 1;
    lower = levels.level();
  }
  return most;
}

/// How many layers from the wall on are good, at most this many.
std::int32_t good_layers(const FanColumns& fan, std::int32_t most) {
  return are_straight(fan.columns) ? count_good_layers<true>(fan, most) : count_good_layers<false>(fan, most);
}

bool has_good_apex(const FanColumns& fan) {
  if (!fan.over.is_sector || fan.over.counts[0] == 0 || fan.over.counts[1] == 0) return true;
  std::array<Vec3, 4> top, directions;
  std::array<Vec3, 5> pyramid;
  for (int i = 0; i < 4; ++i) {
    const CornerColumn& column = fan.columns[i];
    top[i] = pyramid[i] = column.at(column.heights.total(fan.over.counts[i / 2]));
    directions[i] = column.direction;
  }
  pyramid[4] = sector_apex(top, directions);
  return mesh::has_positive_corners(mesh::CellShape::pyramid, pyramid.data());
}

}  // namespace

bool has_good_first_layer(const FanColumns& fan) {
  return good_layers(fan, 1) == 1;
}

double fitting_height(const FanColumns& fan) {
  constexpr double step = 0.95;
  const std::int32_t most = std::max(fan.over.counts[0], fan.over.counts[1]);
  const std::int32_t good = good_layers(fan, most);
  if (good == most && has_good_apex(fan)) return std::numeric_limits<double>::infinity();
  double below = 0, highest = 0;
  for (const int i : {0, 2}) {
    const CornerColumn& column = fan.columns[i];
    below = std::max(below, column.heights.total(std::min(good, column.count)));
    highest = std::max(highest, column.heights.total(column.count));
  }
  return std::min(below, step * highest);
}

}  // namespace aeroloom::layers
