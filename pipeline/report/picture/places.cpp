#include "pipeline/report/picture/places.hpp"

#include "geometry/angle.hpp"
#include "parallel/communication/collective_error.hpp"
#include "pipeline/report/picture/line_items.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace aeroloom::picture {
namespace {

using geometry::Vec3;
using mesh::DistributedMesh;
using mesh::LocalIndex;
using parallel::Communicator;

using geometry::degree;
// The bounds that make a leading edge and a junction were chosen, not measured; with others a picture shows
// another place.

constexpr double sharp_angle = 40 * degree;  ///< edges count on their own from here on
constexpr double corner = 75 * degree;       ///< coarse triangles on a rounding turn by less
/// The flow comes from before a line, within 73 degrees of its normal.
constexpr double least_upstream = 0.3;
/// Of the turn of an edge or triangle: the flow that it divides comes from within that.
constexpr double fraction_of_edge = 0.45, fraction_of_triangle = 0.75;
constexpr double most_of_triangle = 30 * degree;
/// Curvature over the inverse of the diagonal: of a leading edge, which is curved one way, and of the
/// sharpest place.
constexpr double least_curvature = 15, least_curvature_of_any = 8, most_of_other = 0.4;
/// In elements: less is no edge but a bump.
constexpr double least_length = 8;
/// Of the longest line: as long as that, and the one on the left is taken, so that rounding does not choose.
constexpr double as_long = 0.98;
/// Faces meet inwards by more at a junction, along more edges than these.
constexpr double inward_angle = 20 * degree;
constexpr std::size_t least_edges = 10;
constexpr Vec3 upstream{-1, 0, 0};

/// How a triangle is curved; positive where it is convex for the flow.
struct Curvature {
  double largest = 0, smallest = 0;  ///< by absolute value
  Vec3 across, along;                ///< directions of both, unit
};

/// A triangle of the surface with what lies around it.
struct Element {
  std::array<Vec3, 3> corners;
  Vec3 normal;  ///< unit, towards the flow
  double area = 0, size = 0;
  std::array<double, 3> turning_angles = {0, 0, 0};    ///< at the edge from corner i, radians
  std::array<Vec3, 3> bisectors;                       ///< half way between the normals of both sides
  std::array<bool, 3> inside = {false, false, false};  ///< whether the neighbour there is shown

  Vec3 edge(int i) const { return corners[(i + 1) % 3] - corners[i]; }
  Vec3 middle() const { return (corners[0] + corners[1] + corners[2]) / 3; }
};

Element element_of(const mesh::Piece& piece, LocalIndex t, const std::vector<EdgeNeighbour>& neighbours) {
  Element e;
  const LocalIndex* v = piece.cell(t);
  for (int i = 0; i < 3; ++i) e.corners[i] = piece.point(v[i]);
  const Vec3 vector = area_normal(piece, t);
  e.area = 0.5 * norm(vector);
  e.normal = -normalized(vector);
  for (int i = 0; i < 3; ++i) {
    const EdgeNeighbour& neighbour = neighbours[3 * static_cast<std::size_t>(t) + i];
    e.size += norm(e.edge(i)) / 3;
    e.inside[i] = !neighbour.several && neighbour.shown;
    if (!e.inside[i]) continue;
    e.turning_angles[i] = angle_at(-e.normal, e.edge(i), neighbour);
    e.bisectors[i] = normalized(e.normal - neighbour.normal);
  }
  return e;
}

Curvature curvature_of(const Element& e) {
  const Vec3 u = normalized(e.edge(0)), w = cross(e.normal, u);
  double uu = 0, uw = 0, ww = 0;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(e.turning_angles[i]) >= corner) continue;
    const Vec3 across = cross(e.normal, normalized(e.edge(i)));
    const double a = dot(across, u), b = dot(across, w),
                 weight = e.turning_angles[i] * norm(e.edge(i)) / (2 * e.area);
    uu += weight * a * a, uw += weight * a * b, ww += weight * b * b;
  }
  const double mean = 0.5 * (uu + ww), off = std::sqrt(0.25 * (uu - ww) * (uu - ww) + uw * uw);
  const double largest = mean >= 0 ? mean + off : mean - off;
  const double angle = 0.5 * std::atan2(2 * uw, uu - ww) + (mean >= 0 ? 0 : std::numbers::pi / 2);
  const Vec3 across = std::cos(angle) * u + std::sin(angle) * w;
  return {largest, 2 * mean - largest, across, cross(e.normal, across)};
}

/// Calls visit(element, vertices) for what is shown; vertices by global number.
template <class Visit>
void for_each_element(const mesh::NumberedMesh& surface, const EdgeNeighbours& neighbours, const Scene& scene,
                      const Visit& visit) {
  for (std::size_t p = 0; p < surface.pieces.size(); ++p) {
    const mesh::Piece& piece = surface.pieces[p];
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
      if (!scene.shown[p][t]) continue;
      const LocalIndex* v = piece.cell(t);
      const auto& numbers = surface.numbering.vertices[p];
      const Element e = element_of(piece, t, neighbours[p]);
      if (e.area > 0) visit(e, std::array<mesh::GlobalIndex, 3>{numbers[v[0]], numbers[v[1]], numbers[v[2]]});
    }
  }
}

LineItem item_of_triangle(const Element& e, const Curvature& curvature,
                          std::array<mesh::GlobalIndex, 3> vertices) {
  std::sort(vertices.begin(), vertices.end());
  return {vertices, e.middle(), e.normal, curvature.along, std::sqrt(e.area), e.size};
}
LineItem item_of_edge(const Element& e, int i, const std::array<mesh::GlobalIndex, 3>& vertices) {
  const auto [a, b] = std::minmax(vertices[i], vertices[(i + 1) % 3]);
  const double length = norm(e.edge(i));
  return {{a, b, b},      0.5 * (e.corners[i] + e.corners[(i + 1) % 3]),
          e.bisectors[i], normalized(e.edge(i)),
          length,         e.size};
}

/// Whether the flow divides at a line with this normal and direction, if the normal of the section turns by
/// `angle` there.
bool flow_divides(Vec3 normal, Vec3 along, double angle) {
  return dot(normal, upstream) > least_upstream &&
         std::abs(dot(upstream, cross(along, normal))) < std::sin(angle);
}

/// Bits of leading edges. Each sharp_angle edge comes from both of its triangles.
std::vector<LineItem> leading_items(const mesh::NumberedMesh& surface, const EdgeNeighbours& neighbours,
                                    const Scene& scene) {
  std::vector<LineItem> items;
  const double diagonal = scene.box.diagonal();
  for_each_element(surface, neighbours, scene, [&](const Element& e, const auto& vertices) {
    for (int i = 0; i < 3; ++i) {
      if (e.turning_angles[i] < sharp_angle) continue;
      if (flow_divides(e.bisectors[i], normalized(e.edge(i)), fraction_of_edge * e.turning_angles[i]))
        items.push_back(item_of_edge(e, i, vertices));
    }
    const Curvature curvature = curvature_of(e);
    if (curvature.largest * diagonal < least_curvature ||
        std::abs(curvature.smallest) > most_of_other * curvature.largest)
      return;
    const double angle = std::min(fraction_of_triangle * curvature.largest * e.size, most_of_triangle);
    if (flow_divides(e.normal, curvature.along, angle))
      items.push_back(item_of_triangle(e, curvature, vertices));
  });
  return items;
}

/// The item half way along the line.
const LineItem& middle_of(const SurfaceLine& line) {
  int axis = 0;
  for (int k = 1; k < 3; ++k) axis = line.box.size()[k] > line.box.size()[axis] ? k : axis;
  const double middle = line.box.center()[axis];
  return *std::min_element(line.items.begin(), line.items.end(), [&](const LineItem& a, const LineItem& b) {
    return std::abs(a.point[axis] - middle) < std::abs(b.point[axis] - middle);
  });
}

Place place_at(const SurfaceLine& line, const LineItem& item, bool is_upstream) {
  const LineItem mean = smoothed(line, item);
  return {item.point, mean.normal, mean.along, mean.size, is_upstream};
}

/// The finding of rank 0, on every rank.
std::optional<Place> shared(const Communicator& communicator, const std::optional<Place>& found) {
  std::vector<Place> places;
  if (found) places.push_back(*found);
  communicator.broadcast_items(places);
  return places.empty() ? std::nullopt : std::optional(places.front());
}

/// The sharpest edge or the most curved triangle of this rank, with the angle by which it turns.
struct Sharpest {
  double angle = 0;
  LineItem item{};
};
bool is_sharper(const Sharpest& a, const Sharpest& b) {
  return a.angle != b.angle ? a.angle > b.angle : precedes(a.item, b.item);
}

std::optional<Place> find_sharpest(const mesh::NumberedMesh& surface, const EdgeNeighbours& neighbours,
                                   const Scene& scene) {
  const Communicator& communicator = surface.communicator;
  Sharpest mine;
  for_each_element(surface, neighbours, scene, [&](const Element& e, const auto& vertices) {
    const auto take = [&](double angle, const LineItem& item) {
      if (const Sharpest here{angle, item}; is_sharper(here, mine)) mine = here;
    };
    for (int i = 0; i < 3; ++i) {
      if (e.turning_angles[i] >= sharp_angle) take(e.turning_angles[i], item_of_edge(e, i, vertices));
    }
    const Curvature curvature = curvature_of(e);
    if (curvature.largest * scene.box.diagonal() > least_curvature_of_any)
      take(std::min(curvature.largest * e.size, sharp_angle), item_of_triangle(e, curvature, vertices));
  });
  std::vector<Sharpest> all = communicator.all_gather_items<Sharpest>(std::span<const Sharpest>(&mine, 1));
  const Sharpest& best = *std::min_element(all.begin(), all.end(), is_sharper);
  if (!(best.angle > 0)) return std::nullopt;
  const Vec3 normal = best.item.normal, along = best.item.along - dot(best.item.along, normal) * normal;
  return Place{best.item.point, normal, normalized(along), best.item.size, false};
}

}  // namespace

std::optional<Place> find_leading_edge(const mesh::NumberedMesh& surface, const EdgeNeighbours& neighbours,
                                       const Scene& scene) {
  const Communicator& communicator = surface.communicator;
  if (!scene.has_body) return find_sharpest(surface, neighbours, scene);
  std::vector<LineItem> items;
  parallel::agree(communicator, [&] { items = leading_items(surface, neighbours, scene); });
  std::vector<SurfaceLine> lines = gather_lines(communicator, items);
  std::erase_if(
      lines, [](const SurfaceLine& line) { return line.extent() < least_length * line.items.front().size; });
  std::optional<Place> found;
  if (!lines.empty()) {
    double longest = 0;
    for (const SurfaceLine& line : lines) longest = std::max(longest, line.extent());
    std::erase_if(lines, [longest](const SurfaceLine& line) { return line.extent() < as_long * longest; });
    for (const SurfaceLine& line : lines) {
      const LineItem& middle = middle_of(line);
      if (!found || middle.point.y < found->point.y) found = place_at(line, middle, true);
    }
  }
  found = shared(communicator, found);
  return found ? found : find_sharpest(surface, neighbours, scene);
}

std::optional<Place> find_junction(const mesh::NumberedMesh& surface, const EdgeNeighbours& neighbours,
                                   const Scene& scene) {
  const Communicator& communicator = surface.communicator;
  if (!scene.has_body) return std::nullopt;
  std::vector<LineItem> items;
  parallel::agree(communicator, [&] {
    for_each_element(surface, neighbours, scene, [&](const Element& e, const auto& vertices) {
      for (int i = 0; i < 3; ++i) {
        if (e.turning_angles[i] < -inward_angle && vertices[i] < vertices[(i + 1) % 3])
          items.push_back(item_of_edge(e, i, vertices));
      }
    });
  });
  const std::vector<SurfaceLine> lines = gather_lines(communicator, items);
  const auto longest =
      std::max_element(lines.begin(), lines.end(),
                       [](const SurfaceLine& a, const SurfaceLine& b) { return a.extent() < b.extent(); });
  std::optional<Place> found;
  if (longest != lines.end() && longest->items.size() > least_edges) {
    const auto first =
        std::min_element(longest->items.begin(), longest->items.end(),
                         [](const LineItem& a, const LineItem& b) { return a.point.x < b.point.x; });
    found = place_at(*longest, *first, true);
  }
  return shared(communicator, found);
}

}  // namespace aeroloom::picture
