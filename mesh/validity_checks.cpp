#include "mesh/validity_checks.hpp"

#include "mesh/delivery.hpp"
#include "mesh/matching.hpp"
#include "mesh/mixing.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>

namespace aeroloom::mesh {

using geometry::Vec3;

namespace {

bool is_finite(Vec3 p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

/// A shared vertex as one piece has it.
struct SharedPoint {
  GlobalIndex number;
  double coordinates[3];
  PieceId piece;
  LocalIndex vertex;
};

/// An edge is fine when as many triangles pass it one way as the other.
std::optional<Violation> judge_edge(std::span<const Member> members) {
  const auto odd = std::count_if(members.begin(), members.end(), [](const Member& m) { return m.odd(); });
  if (2 * odd == static_cast<std::ptrdiff_t>(members.size())) return std::nullopt;
  return members.size() == 1 ? Violation::edge_of_one_triangle : Violation::edge_unbalanced;
}

}  // namespace

void require_checkable(const parallel::Communicator& communicator, const DistributedMesh& mesh, CellKind kind,
                       const Numbering& numbering) {
  parallel::agree(communicator, [&] {
    if (mesh.kind != kind) throw std::logic_error("the mesh has cells of another kind");
    bool fits = numbering.vertices.size() == mesh.pieces.size();
    for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
      require_consistent_arrays(mesh.pieces[i]);
      fits = fits && mesh.pieces[i].kind == kind &&
             numbering.vertices[i].size() == static_cast<std::size_t>(mesh.pieces[i].vertex_count());
    }
    if (!fits) throw std::logic_error("the numbering does not belong to the mesh");
  });
}

void check_finite_coordinates(const DistributedMesh& mesh, const Numbering& numbering, Findings& findings) {
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    const Piece& piece = mesh.pieces[i];
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      if (is_finite(piece.point(v))) continue;
      findings.add(Violation::coordinate_not_finite,
                   {{numbering.vertices[i][v]}, piece.id, Entity::vertex, v});
    }
  }
}

void check_orphans(const DistributedMesh& mesh, const Numbering& numbering, Findings& findings) {
  std::vector<std::uint8_t> used;
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    const Piece& piece = mesh.pieces[i];
    used.assign(piece.vertex_count(), 0);
    for (const LocalIndex v : piece.cells) used[v] = 1;
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      if (used[v]) continue;
      findings.add(Violation::orphan_vertex, {{numbering.vertices[i][v]}, piece.id, Entity::vertex, v});
    }
  }
}

void check_labels(const DistributedMesh& mesh, Findings& findings) {
  const auto names = [](std::int32_t id, const std::vector<std::string>& list) {
    return id >= 0 && static_cast<std::size_t>(id) < list.size();
  };
  for (const Piece& piece : mesh.pieces) {
    for (LocalIndex t = 0; t < piece.boundary_count(); ++t) {
      const Offender offender{{piece.id, t}, piece.id, Entity::triangle, t};
      if (!names(piece.triangle_patch[t], mesh.patches))
        findings.add(Violation::triangle_without_patch, offender);
      if (!names(piece.triangle_face[t], mesh.faces))
        findings.add(Violation::triangle_without_face, offender);
    }
  }
}

void check_shared_coordinates(const parallel::Communicator& communicator, const DistributedMesh& mesh,
                              const Numbering& numbering, Findings& findings) {
  std::vector<SharedPoint> mine;
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    const Piece& piece = mesh.pieces[i];
    for (const LocalIndex v : piece.shared_vertices) {
      const Vec3 p = piece.point(v);
      mine.push_back({numbering.vertices[i][v], {p.x, p.y, p.z}, piece.id, v});
    }
  }
  std::vector<SharedPoint> met = deliver(communicator, mine, [&](const SharedPoint& point) {
    return meeting_rank(mix_bits(static_cast<std::uint64_t>(point.number)), communicator.size());
  });
  std::sort(met.begin(), met.end(), [](const SharedPoint& a, const SharedPoint& b) {
    return std::tie(a.number, a.piece, a.vertex) < std::tie(b.number, b.piece, b.vertex);
  });
  for (std::size_t i = 1, owner = 0; i < met.size(); ++i) {
    if (met[i].number != met[owner].number) {
      owner = i;
    } else if (std::memcmp(met[i].coordinates, met[owner].coordinates, sizeof met[i].coordinates) != 0) {
      findings.add(Violation::shared_coordinates_differ,
                   {{met[i].number}, met[i].piece, Entity::vertex, met[i].vertex});
    }
  }
}

void check_boundary_edges(const parallel::Communicator& communicator, const DistributedMesh& mesh,
                          const Numbering& numbering, Findings& findings) {
  const auto edges = [](const Piece& piece, const auto& sink) {
    for (LocalIndex t = 0; t < piece.boundary_count(); ++t) {
      const LocalIndex* v = piece.boundary_triangle(t);
      for (int k = 0; k < 3; ++k) {
        sink(std::array<LocalIndex, 2>{v[k], v[(k + 1) % 3]}, 0, static_cast<std::uint32_t>(3 * t + k));
      }
    }
  };
  match_all<2>(communicator, mesh, numbering, {Entity::triangle_edge, Entity::triangle_edge}, edges,
               judge_edge, findings);
}

void CompensatedSum::add(double term) {
  const double sum = _sum + term;
  _error += std::abs(_sum) >= std::abs(term) ? (_sum - sum) + term : (term - sum) + _sum;
  _sum = sum;
}

Vec3 center_of_mesh(const parallel::Communicator& communicator, const DistributedMesh& mesh) {
  geometry::Box box;
  for (const Piece& piece : mesh.pieces) {
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      if (is_finite(piece.point(v))) box.add(piece.point(v));
    }
  }
  Vec3 center;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = communicator.minimum(box.low[axis]), high = communicator.maximum(box.high[axis]);
    center[axis] = low <= high ? low + 0.5 * (high - low) : 0;
  }
  return center;
}

double enclosed_volume(const Piece& piece, Vec3 origin) {
  CompensatedSum sum;
  for (LocalIndex t = 0; t < piece.boundary_count(); ++t) {
    const LocalIndex* v = piece.boundary_triangle(t);
    const Vec3 a = piece.point(v[0]) - origin, b = piece.point(v[1]) - origin, c = piece.point(v[2]) - origin;
    sum.add(geometry::dot(a, geometry::cross(b, c)));
  }
  return sum.value() / 6;
}

double sum_over_pieces(const parallel::Communicator& communicator, const DistributedMesh& mesh,
                       const std::vector<double>& values) {
  CompensatedSum sum;
  for (const double value : gather_by_piece(communicator, mesh, values)) sum.add(value);
  return sum.value();
}

}  // namespace aeroloom::mesh
