#include "pipeline/report/picture/scene.hpp"

#include "mesh/data/bounds.hpp"
#include "mesh/exchange/delivery.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>

namespace aeroloom::picture {
namespace {

using geometry::Box;
using geometry::Vec3;
using mesh::DistributedMesh;
using mesh::LocalIndex;
using mesh::PatchType;
using parallel::Communicator;

/// Directions spread evenly over the sphere, along a spiral. Some 15 degrees apart.
constexpr int direction_count = 200;
std::array<Vec3, direction_count> even_directions() {
  std::array<Vec3, direction_count> directions;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < direction_count; ++i) {
    const double z = 1 - (2 * i + 1.0) / direction_count, radius = std::sqrt(1 - z * z);
    directions[i] = {radius * std::cos(golden * i), radius * std::sin(golden * i), z};
  }
  return directions;
}

/// The point that is farthest in a direction, ties by place.
struct Farthest {
  double value = 0;
  Vec3 point;
  std::int64_t direction = 0;
};
bool is_farther(const Farthest& a, const Farthest& b) {
  return std::tie(a.value, a.point.x, a.point.y, a.point.z) >
         std::tie(b.value, b.point.x, b.point.y, b.point.z);
}

/// The farthest points of the mesh in the even directions.
std::vector<Farthest> hull_points(const DistributedMesh& surface) {
  const Communicator& communicator = surface.communicator;
  const auto directions = even_directions();
  std::vector<Farthest> mine;
  for (const mesh::Piece& piece : surface.pieces) {
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      const Vec3 p = piece.point(v);
      if (mine.empty()) {
        for (int d = 0; d < direction_count; ++d) mine.push_back({dot(directions[d], p), p, d});
      }
      for (int d = 0; d < direction_count; ++d) {
        const Farthest here{dot(directions[d], p), p, d};
        if (here.value >= mine[d].value && is_farther(here, mine[d])) mine[d] = here;
      }
    }
  }
  std::vector<Farthest> best;
  for (const Farthest& each : communicator.all_gather_items<Farthest>(mine)) {
    if (best.size() < direction_count) {
      best.push_back(each);
    } else if (is_farther(each, best[each.direction])) {
      best[each.direction] = each;
    }
  }
  return best;
}

/// Marks the triangles on the convex hull. Chords of a round far field leave it by a fraction of their
/// length; half a fin at a plane of symmetry may be as close, but not for its own small triangles.
Shown triangles_on_hull(const DistributedMesh& surface) {
  constexpr double fraction = 0.15;  // chosen, not measured
  const std::vector<Farthest> hull = hull_points(surface);
  Shown marks;
  for (const mesh::Piece& piece : surface.pieces) {
    std::vector<std::uint8_t>& of_piece = marks.emplace_back(piece.cell_count(), 0);
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const LocalIndex* v = piece.cell(t);
      const Vec3 a = piece.point(v[0]), b = piece.point(v[1]), c = piece.point(v[2]);
      const double longest = std::max({distance(a, b), distance(b, c), distance(c, a)});
      const Vec3 normal = normalized(area_normal(piece, t));
      of_piece[t] = std::all_of(hull.begin(), hull.end(), [&](const Farthest& far) {
        return dot(normal, far.point - a) <= fraction * longest;
      });
    }
  }
  return marks;
}

/// Sums over the marked triangles of a piece, and the volume of all of them.
struct PieceSums {
  std::int32_t patch = -1, marked = 0, unmarked = 0;
  double area = 0, volume = 0, whole_volume = 0;
  Vec3 area_vector;
  Box box;
};

/// By piece, of the whole mesh; volumes are those of the cones from `origin`.
std::vector<PieceSums> sums_of_pieces(const DistributedMesh& surface, const Shown& marks, Vec3 origin) {
  std::vector<PieceSums> rows;
  for (std::size_t p = 0; p < surface.pieces.size(); ++p) {
    const mesh::Piece& piece = surface.pieces[p];
    PieceSums& row = rows.emplace_back();
    if (!piece.triangle_patch.empty()) row.patch = piece.triangle_patch.front();
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const Vec3 vector = 0.5 * area_normal(piece, t);
      const double volume = dot(vector, piece.point(piece.cell(t)[0]) - origin) / 3;
      row.whole_volume += volume;
      ++(marks[p][t] ? row.marked : row.unmarked);
      if (!marks[p][t]) continue;
      row.area += norm(vector), row.area_vector += vector, row.volume += volume;
      for (int k = 0; k < 3; ++k) row.box.add(piece.point(piece.cell(t)[k]));
    }
  }
  return mesh::gather_by_piece(surface, rows);
}

/// Whether the marked triangles are the outer walls of a domain with something in it.
bool enclose_the_rest(const std::vector<PieceSums>& rows) {
  double area = 0, volume = 0, whole = 0;
  Vec3 vector;
  std::int64_t rest = 0;
  for (const PieceSums& row : rows) {
    area += row.area, volume += row.volume, vector += row.area_vector;
    whole += row.whole_volume;
    rest += row.unmarked;
  }
  // Closed but for the plane of symmetry of half a domain, and with nearly all of the volume inside.
  constexpr double open_fraction = 0.15, most_of_volume = 0.9;
  return rest > 0 && area > 0 && norm(vector) <= open_fraction * area && volume >= most_of_volume * whole;
}

void add_up(const std::vector<PieceSums>& rows, Scene& scene) {
  double area = 0;
  for (const PieceSums& row : rows) {
    if (row.marked == 0) continue;
    scene.box.add(row.box);
    scene.open_towards += -1 * row.area_vector;
    area += row.area;
    if (row.patch < 0 || static_cast<std::size_t>(row.patch) >= scene.patches.size()) continue;
    scene.patches[row.patch] = 1;
    scene.patch_areas[row.patch] += row.area;
  }
  if (area > 0) scene.open_towards *= 1 / area;
}

/// Marks the walls that are not outer ones; openings too where there is no body.
Shown marked_walls(const DistributedMesh& surface, const std::vector<PatchType>& types, const Shown& outer,
                   bool has_body) {
  Shown shown;
  for (std::size_t p = 0; p < surface.pieces.size(); ++p) {
    const mesh::Piece& piece = surface.pieces[p];
    std::vector<std::uint8_t>& of_piece = shown.emplace_back(piece.cell_count(), 0);
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const std::int32_t patch = piece.triangle_patch[t];
      const PatchType type =
          patch >= 0 && static_cast<std::size_t>(patch) < types.size() ? types[patch] : PatchType::wall;
      const bool is_wall = type == PatchType::wall || type == PatchType::slip;
      const bool is_opening = type == PatchType::inlet || type == PatchType::outlet;
      of_piece[t] = !surface.sides_of(piece.triangle_face[t]).is_inner() && (!has_body || !outer[p][t]) &&
                    (is_wall || (is_opening && !has_body));
    }
  }
  return shown;
}

Shown all_of(const DistributedMesh& surface, std::uint8_t mark) {
  Shown marks;
  for (const mesh::Piece& piece : surface.pieces) marks.emplace_back(piece.cell_count(), mark);
  return marks;
}

}  // namespace

Vec3 area_normal(const mesh::Piece& piece, LocalIndex triangle) {
  const LocalIndex* v = piece.boundary_triangle(triangle);
  const Vec3 a = piece.point(v[0]);
  return cross(piece.point(v[1]) - a, piece.point(v[2]) - a);
}

Scene find_scene(const DistributedMesh& surface, const std::vector<PatchType>& types) {
  Scene scene;
  scene.domain = mesh::box_of(surface);
  const Vec3 origin = scene.domain.center();
  Shown outer = all_of(surface, 0);
  scene.has_body = std::find(types.begin(), types.end(), PatchType::farfield) != types.end();
  if (!scene.has_body) {
    outer = triangles_on_hull(surface);
    scene.has_body = enclose_the_rest(sums_of_pieces(surface, outer, origin));
  }
  scene.patches.assign(surface.patches.size(), 0);
  scene.patch_areas.assign(surface.patches.size(), 0);
  scene.shown = marked_walls(surface, types, outer, scene.has_body);
  std::vector<PieceSums> rows = sums_of_pieces(surface, scene.shown, origin);
  if (std::all_of(rows.begin(), rows.end(), [](const PieceSums& row) { return row.marked == 0; })) {
    scene.has_body = false;
    scene.shown = all_of(surface, 1);
    rows = sums_of_pieces(surface, scene.shown, origin);
  }
  add_up(rows, scene);
  return scene;
}

}  // namespace aeroloom::picture
