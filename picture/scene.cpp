#include "picture/scene.hpp"

#include "mesh/delivery.hpp"
#include "picture/folds.hpp"

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

/// Directions spread evenly over the sphere, along a spiral.
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

/// The item with the largest value, ties by place.
struct Extreme {
  std::int32_t slot = 0, face = 0;
  double value = 0;
  Vec3 point, normal;
};
bool beats(const Extreme& a, const Extreme& b) {
  return std::tie(a.value, a.point.x, a.point.y, a.point.z) >
         std::tie(b.value, b.point.x, b.point.y, b.point.z);
}

/// The best of all ranks for each (face, slot), by face, then slot.
std::vector<Extreme> best_of_all(const Communicator& communicator, const std::vector<Extreme>& mine) {
  std::vector<Extreme> all = communicator.all_gather_items<Extreme>(mine);
  std::sort(all.begin(), all.end(), [](const Extreme& a, const Extreme& b) {
    return std::tie(a.face, a.slot) != std::tie(b.face, b.slot)
               ? std::tie(a.face, a.slot) < std::tie(b.face, b.slot)
               : beats(a, b);
  });
  const auto same = [](const Extreme& a, const Extreme& b) { return a.face == b.face && a.slot == b.slot; };
  all.erase(std::unique(all.begin(), all.end(), same), all.end());
  return all;
}

/// The farthest points of the mesh in the even directions.
std::vector<Extreme> hull_points(const Communicator& communicator, const DistributedMesh& surface) {
  const auto directions = even_directions();
  std::vector<Extreme> farthest;
  for (const mesh::Piece& piece : surface.pieces) {
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      const Vec3 p = piece.point(v);
      if (farthest.empty()) {
        for (int d = 0; d < direction_count; ++d) farthest.push_back({d, 0, dot(directions[d], p), p, {}});
      }
      for (int d = 0; d < direction_count; ++d) {
        const Extreme here{d, 0, dot(directions[d], p), p, {}};
        if (here.value >= farthest[d].value && beats(here, farthest[d])) farthest[d] = here;
      }
    }
  }
  return best_of_all(communicator, farthest);
}

/// The largest triangle of each face and its outermost ones in four directions.
std::vector<Extreme> samples_of_faces(const Communicator& communicator, const DistributedMesh& surface,
                                      std::size_t faces) {
  constexpr int slots = 5;
  const std::array<Vec3, 4> directions = {{{1, 0.3, 0.2}, {-1, -0.3, -0.2}, {0.1, 1, -0.9}, {-0.1, -1, 0.9}}};
  std::vector<Extreme> best(slots * faces, Extreme{-1, 0, 0, {}, {}});
  for (const mesh::Piece& piece : surface.pieces) {
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const std::int32_t face = piece.triangle_face[t];
      const LocalIndex* v = piece.cell(t);
      const Vec3 middle = (piece.point(v[0]) + piece.point(v[1]) + piece.point(v[2])) / 3;
      const Vec3 normal = area_normal(piece, t);
      for (int slot = 0; slot < slots; ++slot) {
        const double value = slot == 0 ? norm(normal) : dot(directions[slot - 1], middle);
        Extreme& kept = best[static_cast<std::size_t>(slots) * face + slot];
        const Extreme here{slot, face, value, middle, normalized(normal)};
        if (kept.slot < 0 || beats(here, kept)) kept = here;
      }
    }
  }
  std::erase_if(best, [](const Extreme& each) { return each.slot < 0; });
  return best_of_all(communicator, best);
}

/// By face: whether all its samples lie on the hull.
std::vector<std::uint8_t> faces_on_hull(const Communicator& communicator, const DistributedMesh& surface,
                                        std::size_t faces, double diagonal) {
  const std::vector<Extreme> hull = hull_points(communicator, surface);
  std::vector<std::uint8_t> on_hull(faces, 1);
  for (const Extreme& sample : samples_of_faces(communicator, surface, faces)) {
    for (const Extreme& far : hull) {
      if (dot(sample.normal, far.point - sample.point) > 0.02 * diagonal) on_hull[sample.face] = 0;
    }
  }
  return on_hull;
}

/// Sums over the triangles of a piece.
struct PieceSums {
  std::int32_t face = -1, patch = -1;
  double area = 0, volume = 0;
  Vec3 area_vector;
  Box box;
};

/// By piece, of the whole mesh; volumes are those of the cones from `origin`.
std::vector<PieceSums> sums_of_pieces(const Communicator& communicator, const DistributedMesh& surface,
                                      Vec3 origin) {
  std::vector<PieceSums> rows;
  for (const mesh::Piece& piece : surface.pieces) {
    PieceSums& row = rows.emplace_back();
    row.face = piece.common_face();
    if (!piece.triangle_patch.empty()) row.patch = piece.triangle_patch.front();
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const Vec3 vector = 0.5 * area_normal(piece, t);
      row.area += norm(vector);
      row.area_vector += vector;
      row.volume += dot(vector, piece.point(piece.cell(t)[0]) - origin) / 3;
    }
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) row.box.add(piece.point(v));
  }
  return mesh::gather_by_piece(communicator, surface, rows);
}

/// Whether these faces are the outer walls of a domain with something in it.
bool enclose_the_rest(const std::vector<PieceSums>& rows, const std::vector<std::uint8_t>& faces) {
  double area = 0, volume = 0, whole = 0;
  Vec3 vector;
  bool is_rest = false;
  for (const PieceSums& row : rows) {
    whole += row.volume;
    if (row.face < 0) continue;
    if (!faces[row.face]) {
      is_rest = true;
      continue;
    }
    area += row.area, volume += row.volume, vector += row.area_vector;
  }
  return is_rest && area > 0 && norm(vector) <= 0.05 * area && volume >= 0.9 * whole;
}

std::size_t face_count(const Communicator& communicator, const DistributedMesh& surface) {
  std::int64_t count = static_cast<std::int64_t>(surface.faces.size());
  for (const mesh::Piece& piece : surface.pieces) {
    for (const std::int32_t face : piece.triangle_face) count = std::max<std::int64_t>(count, face + 1);
  }
  return static_cast<std::size_t>(communicator.maximum(count));
}

void add_up(const std::vector<PieceSums>& rows, Scene& scene) {
  double area = 0;
  for (const PieceSums& row : rows) {
    if (!scene.shows(row.face)) continue;
    scene.box.add(row.box);
    scene.open_towards += -1 * row.area_vector;
    area += row.area;
    if (row.patch < 0 || static_cast<std::size_t>(row.patch) >= scene.patches.size()) continue;
    scene.patches[row.patch] = 1;
    scene.patch_areas[row.patch] += row.area;
  }
  if (area > 0) scene.open_towards *= 1 / area;
}

}  // namespace

Scene find_scene(const Communicator& communicator, const DistributedMesh& surface,
                 const std::vector<PatchType>& types) {
  Scene scene;
  Box mine;
  for (const mesh::Piece& piece : surface.pieces) {
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) mine.add(piece.point(v));
  }
  for (int axis = 0; axis < 3; ++axis) {
    scene.domain.low[axis] = communicator.minimum(mine.low[axis]);
    scene.domain.high[axis] = communicator.maximum(mine.high[axis]);
  }
  const std::size_t faces = face_count(communicator, surface);
  const std::vector<PieceSums> rows = sums_of_pieces(communicator, surface, scene.domain.center());
  const auto type_of = [&](std::int32_t patch) {
    return patch >= 0 && static_cast<std::size_t>(patch) < types.size() ? types[patch] : PatchType::wall;
  };
  scene.has_body = std::find(types.begin(), types.end(), PatchType::farfield) != types.end();
  std::vector<std::uint8_t> outer(faces, 0);
  if (!scene.has_body) {
    outer = faces_on_hull(communicator, surface, faces, scene.domain.diagonal());
    scene.has_body = enclose_the_rest(rows, outer);
  }
  if (!scene.has_body) outer.assign(faces, 0);
  scene.shown.assign(faces, 0);
  scene.patches.assign(surface.patches.size(), 0);
  scene.patch_areas.assign(surface.patches.size(), 0);
  for (const PieceSums& row : rows) {
    if (row.face < 0 || surface.sides_of(row.face).is_inner()) continue;
    const PatchType type = type_of(row.patch);
    const bool is_wall = type == PatchType::wall || type == PatchType::slip;
    const bool is_opening = type == PatchType::inlet || type == PatchType::outlet;
    scene.shown[row.face] = !outer[row.face] && (is_wall || (is_opening && !scene.has_body));
  }
  if (std::find(scene.shown.begin(), scene.shown.end(), 1) == scene.shown.end()) {
    scene.has_body = false;
    scene.shown.assign(faces, 1);
  }
  add_up(rows, scene);
  return scene;
}

}  // namespace aeroloom::picture
