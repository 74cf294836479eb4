#include "sizing/sources/size_requests.hpp"

#include "sizing/sources/cells_where.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aeroloom::sizing {

using geometry::Vec3;

namespace {

/// Of the size: two sources of a line are no farther apart.
constexpr double step_along = 0.5;

double steps_between(const SizeLine& line, std::size_t i, double coarsening) {
  const double size = coarsening * std::min(line.sizes[i], line.sizes[i + 1]);
  return std::ceil(std::max(1.0, distance(line.points[i], line.points[i + 1]) / (step_along * size)));
}

}  // namespace

double points_along(const SizeLine& line, double coarsening) {
  double points = 1;
  for (std::size_t i = 0; i + 1 < line.points.size(); ++i) points += steps_between(line, i, coarsening);
  return points;
}

std::vector<SizeSource> sources_along(const RootCube& root, const SizeLine& line, double coarsening) {
  std::vector<SizeSource> sources;
  for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
    const double steps = steps_between(line, i, coarsening);
    for (int k = i == 0 ? 0 : 1; k <= steps; ++k) {
      const double part = k / steps;
      sources.push_back({line.points[i] + part * (line.points[i + 1] - line.points[i]),
                         coarsening * (line.sizes[i] + part * (line.sizes[i + 1] - line.sizes[i]))});
    }
  }
  return thin_sources(root, sources);
}

std::vector<double> sizes_on_faces(const cad::Model& model, const SizeRequests& requests) {
  std::vector<double> sizes(model.face_count(), 0);
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    const std::string& patch = model.patches()[model.face(f).patch];
    for (const PatchSize& asked : requests.patches) {
      if (asked.patch == patch) sizes[f] = asked.size;
    }
  }
  return sizes;
}

double cells_in(const RootCube& root, const SizeRegion& region, double size) {
  const double edge = std::ldexp(root.edge, -root.level(size));
  const Vec3 high = root.low + Vec3{root.edge, root.edge, root.edge};
  const geometry::Box box = box_of(region.shape);
  double cells = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double extent = std::min(box.high[axis], high[axis]) - std::max(box.low[axis], root.low[axis]);
    if (extent < 0) return 0;
    cells *= extent / edge + 1;
  }
  return std::min(cells, cells_of(region.shape, edge));
}

std::vector<SizeSource> sources_in(const RootCube& root, const SizeRegion& region, double size, int rank,
                                   int ranks) {
  const auto ask = [&](Vec3 middle, double half) {
    if (distance_to(region.shape, middle) > std::numbers::sqrt3 * half) return CubeRequest{};
    return CubeRequest{size, size};
  };
  return sources_where(root, ask, {rank, ranks});
}

}  // namespace aeroloom::sizing
