#include "surface/charts/plane_cut.hpp"
#include "surface/charts/surface_topology.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace aeroloom::surface {
namespace {

using geometry::Vec3;

/// A triangle as the rating of planes needs it, computed once for all planes.
struct Facet {
  Vec3 center, area_vector;
  double area;
  std::array<Vec3, 3> corners;
};

std::vector<Facet> list_facets(const ChartSurface& surface) {
  std::vector<Facet> facets;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    const std::array<Vec3, 3> corners{surface.points[a], surface.points[b], surface.points[c]};
    const Vec3 vector = area_vector(surface, static_cast<std::int32_t>(t));
    facets.push_back({(corners[0] + corners[1] + corners[2]) / 3, vector, norm(vector), corners});
  }
  return facets;
}

/// Unit eigenvectors of a symmetric matrix that is the sum of weight * v v^T.
class PrincipalAxes {
public:
  void add(double weight, Vec3 v) {
    const Eigen::Vector3d e(v.x, v.y, v.z);
    _sum += weight * e * e.transpose();
  }
  std::array<Vec3, 3> axes() const {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(_sum);
    std::array<Vec3, 3> result;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d v = solver.eigenvectors().col(i);
      result[i] = {v[0], v[1], v[2]};
    }
    return result;
  }

private:
  Eigen::Matrix3d _sum = Eigen::Matrix3d::Zero();
};

/// The coordinate axes, then the principal axes of the positions and of the normals.
std::vector<Vec3> candidate_normals(const std::vector<Facet>& facets, Vec3 center) {
  std::vector<Vec3> normals{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  PrincipalAxes positions, directions;
  Vec3 mean;
  for (const Facet& facet : facets) {
    positions.add(facet.area, facet.center - center);
    directions.add(facet.area, normalized(facet.area_vector));
    mean += facet.area_vector;
  }
  for (const PrincipalAxes& principal : {positions, directions}) {
    for (const Vec3 axis : principal.axes()) normals.push_back(axis);
  }
  if (norm(mean) > 0) normals.push_back(normalized(mean));
  return normals;
}

// Flatness decides, as charts of flat sides stretch least; balance counts for less, and beyond 60 % for
// nothing, since sides are divided again; a cut as long as the root of the area costs a twentieth. Chosen,
// not measured.
constexpr double weight_of_balance = 0.3, enough_balance = 0.6, weight_of_length = 0.05;
/// Planes beside the centroid, by this fraction of the extent: where the best one through it runs along a
/// crease. Chosen, not measured.
constexpr double beside_centroid = 0.11;
/// Ties go to the coordinate axes, whose three planes each are the first, and to planes through the centroid:
/// symmetric bodies are then cut symmetrically. Less than any of the weights.
constexpr std::size_t planes_of_axes = 9;
constexpr double preference_of_axes = 0.02, preference_of_centroid = 0.01;

double crossing_length(const Facet& facet, const CutPlane& plane) {
  std::array<Vec3, 2> ends;
  int count = 0;
  for (int i = 0; i < 3 && count < 2; ++i) {
    const Vec3 a = facet.corners[i], b = facet.corners[(i + 1) % 3];
    const double fa = dot(plane.normal, a) - plane.offset, fb = dot(plane.normal, b) - plane.offset;
    if ((fa < 0) == (fb < 0)) continue;
    ends[count++] = a + (fa / (fa - fb)) * (b - a);
  }
  return count == 2 ? distance(ends[0], ends[1]) : 0;
}

/// Flatness of the sides (1: planar) and balance against the length of the cut.
double rate(const std::vector<Facet>& facets, const CutPlane& plane) {
  std::array<Vec3, 2> vectors;
  std::array<double, 2> areas{};
  double cut = 0;
  for (const Facet& facet : facets) {
    const int side = dot(plane.normal, facet.center) >= plane.offset;
    vectors[side] += facet.area_vector;
    areas[side] += facet.area;
    cut += crossing_length(facet, plane);
  }
  const double total = areas[0] + areas[1];
  const double flatness = (norm(vectors[0]) + norm(vectors[1])) / total;
  const double balance = 2 * std::min(areas[0], areas[1]) / total;
  return flatness + weight_of_balance * std::min(balance, enough_balance) -
         weight_of_length * cut / std::sqrt(total);
}

}  // namespace

std::vector<CutPlane> propose_planes(const ChartSurface& surface) {
  const std::vector<Facet> facets = list_facets(surface);
  Vec3 center;
  double area = 0;
  for (const Facet& facet : facets) center += facet.area * facet.center, area += facet.area;
  if (!(area > 0)) return {};
  center = center / area;
  struct Rated {
    double rating;
    CutPlane plane;
  };
  std::vector<Rated> rated;
  for (const Vec3 normal : candidate_normals(facets, center)) {
    double low = 1e300, high = -1e300;
    for (const Vec3 p : surface.points)
      low = std::min(low, dot(normal, p)), high = std::max(high, dot(normal, p));
    for (const double shift : {0.0, beside_centroid, -beside_centroid}) {
      const CutPlane plane{normal, dot(normal, center) + shift * (high - low)};
      const double preference = (rated.size() < planes_of_axes ? preference_of_axes : 0.0) +
                                (shift == 0 ? preference_of_centroid : 0.0);
      rated.push_back({rate(facets, plane) + preference, plane});
    }
  }
  std::stable_sort(rated.begin(), rated.end(),
                   [](const Rated& a, const Rated& b) { return a.rating > b.rating; });
  std::vector<CutPlane> planes;
  planes.reserve(rated.size());
  for (const Rated& r : rated) planes.push_back(r.plane);
  return planes;
}

}  // namespace aeroloom::surface
