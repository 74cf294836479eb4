#include "layers/end_planes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace aeroloom::layers {
namespace {

using geometry::Vec3;

/// Cosine of the angle between normals of one plane, at least: rounding of coordinates turns them by less.
constexpr double same_plane = 1 - 1e-12;

bool has_layers(const LayerOptions& options, std::int32_t patch) {
  return static_cast<std::size_t>(patch) < options.patches.size() && options.patches[patch].first > 0;
}

bool may_end_on(const mesh::DistributedMesh& mesh, const LayerOptions& options, std::int32_t patch) {
  return !has_layers(options, patch) && layers::may_end_on(mesh.type_of_patch(patch));
}

/// Calls visit(piece, triangle, face) for the triangles on faces that layers may end on.
template <class Visit>
void for_each_candidate(const mesh::DistributedMesh& mesh, const LayerOptions& options, const Visit& visit) {
  for (const mesh::Piece& piece : mesh.pieces) {
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const std::int32_t face = piece.triangle_face[t];
      if (face < 0 || mesh.sides_of(face).is_inner()) continue;
      if (may_end_on(mesh, options, piece.triangle_patch[t])) visit(piece, t, static_cast<std::size_t>(face));
    }
  }
}

Vec3 area_vector(const mesh::Piece& piece, mesh::LocalIndex t) {
  const mesh::LocalIndex* v = piece.cell(t);
  return cross(piece.point(v[1]) - piece.point(v[0]), piece.point(v[2]) - piece.point(v[0]));
}

/// The largest triangle that a piece has of a face.
struct LargestTriangle {
  Vec3 area;
  std::int32_t face = 0;
  mesh::PieceId piece = 0;
};

/// The normal of the largest triangle that the lowest piece of each face has of it.
std::vector<Vec3> reference_normals(const mesh::DistributedMesh& mesh, const LayerOptions& options) {
  std::vector<LargestTriangle> mine;
  for_each_candidate(mesh, options, [&](const mesh::Piece& piece, mesh::LocalIndex t, std::size_t face) {
    const Vec3 area = area_vector(piece, t);
    const auto same = std::find_if(mine.rbegin(), mine.rend(), [&](const LargestTriangle& l) {
      return l.piece == piece.id && static_cast<std::size_t>(l.face) == face;
    });
    if (same == mine.rend()) {
      mine.push_back({area, static_cast<std::int32_t>(face), piece.id});
    } else if (dot(area, area) > dot(same->area, same->area)) {
      same->area = area;
    }
  });
  std::vector<LargestTriangle> all =
      mesh.communicator.all_gather_items(std::span<const LargestTriangle>(mine));
  std::sort(all.begin(), all.end(),
            [](const LargestTriangle& a, const LargestTriangle& b) { return a.piece > b.piece; });
  std::vector<Vec3> normals(mesh.faces.size());
  for (const LargestTriangle& l : all) normals[l.face] = normalized(l.area);
  return normals;
}

}  // namespace

std::vector<Vec3> find_end_planes(const mesh::DistributedMesh& mesh, const LayerOptions& options) {
  if (!options.ends_on_planes) return std::vector<Vec3>(mesh.faces.size());
  std::vector<Vec3> normals = reference_normals(mesh, options);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> ends(6 * normals.size(), infinity), agreement(normals.size(), 1);
  for_each_candidate(mesh, options, [&](const mesh::Piece& piece, mesh::LocalIndex t, std::size_t face) {
    agreement[face] = std::min(agreement[face], dot(normals[face], normalized(area_vector(piece, t))));
    for (int i = 0; i < 3; ++i) {
      const Vec3 p = piece.point(piece.cell(t)[i]);
      for (int axis = 0; axis < 3; ++axis) {
        ends[6 * face + axis] = std::min(ends[6 * face + axis], p[axis]);
        ends[6 * face + 3 + axis] = std::min(ends[6 * face + 3 + axis], -p[axis]);
      }
    }
  });
  mesh.communicator.minimum_each(ends);
  mesh.communicator.minimum_each(agreement);
  for (std::size_t face = 0; face < normals.size(); ++face) {
    if (!(agreement[face] >= same_plane)) normals[face] = {};
    for (int axis = 0; axis < 3; ++axis) {
      if (ends[6 * face + axis] != -ends[6 * face + 3 + axis]) continue;
      const double sign = normals[face][axis];
      normals[face] = {};
      if (sign != 0) normals[face][axis] = sign > 0 ? 1 : -1;
    }
  }
  return normals;
}

std::vector<std::uint8_t> find_curved_ends(const mesh::DistributedMesh& mesh, const LayerOptions& options,
                                           const std::vector<Vec3>& planes,
                                           const mesh::SharedVertices& shared) {
  std::vector<std::uint8_t> found(mesh.faces.size(), 0);
  if (!options.curved_ends) return found;
  const auto is_candidate = [&](std::int32_t face, std::int32_t patch) {
    if (face < 0 || mesh.sides_of(face).is_inner() || !(planes[face] == Vec3{})) return false;
    return may_end_on(mesh, options, patch) ||
           (!has_layers(options, patch) && mesh.type_of_patch(patch) == mesh::PatchType::farfield);
  };
  constexpr std::uint32_t wall = 1;
  std::vector<std::vector<std::uint32_t>> meets;  // by piece and vertex: whether a wall with layers has it
  for (const mesh::Piece& piece : mesh.pieces) {
    std::vector<std::uint32_t>& of_piece = meets.emplace_back(piece.vertex_count(), 0);
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const std::int32_t patch = piece.triangle_patch[t];
      if (!has_layers(options, patch)) continue;
      const bool is_bare = mesh.sides_of(piece.triangle_face[t]).is_inner() &&
                           inner_sides_of(options, static_cast<std::size_t>(patch)) == InnerSides::none;
      if (is_bare) continue;
      for (int i = 0; i < 3; ++i) of_piece[piece.cell(t)[i]] = wall;
    }
  }
  shared.combine(meets, [](std::uint32_t a, std::uint32_t b) { return a | b; });
  std::vector<double> none(mesh.faces.size(), 1);
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const mesh::Piece& piece = mesh.pieces[p];
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const std::int32_t face = piece.triangle_face[t];
      const mesh::LocalIndex* v = piece.cell(t);
      if ((meets[p][v[0]] | meets[p][v[1]] | meets[p][v[2]]) == 0) continue;
      if (is_candidate(face, piece.triangle_patch[t])) none[face] = 0;
    }
  }
  mesh.communicator.minimum_each(none);
  for (std::size_t face = 0; face < found.size(); ++face) found[face] = none[face] == 0 ? 1 : 0;
  return found;
}

Vec3 along_planes(Vec3 direction, std::span<const Vec3> normals) {
  if (normals.size() == 1) direction -= dot(normals[0], direction) * normals[0];
  if (normals.size() == 2) {
    const Vec3 line = normalized(cross(normals[0], normals[1]));
    direction = dot(line, direction) * line;
  }
  for (const Vec3 normal : normals) {
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(normal[axis]) == 1) direction[axis] = -0.0;
    }
  }
  return direction;
}

}  // namespace aeroloom::layers
