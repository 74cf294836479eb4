#include "mesh/checks/validity_checks.hpp"

#include "mesh/data/mixing.hpp"
#include "mesh/data/piece_faces.hpp"
#include "mesh/exchange/matching.hpp"
#include "mesh/exchange/rendezvous.hpp"
#include "mesh/quality/cell_measures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

namespace aeroloom::mesh {

using geometry::Vec3;

namespace {

/// Around the front region an inner triangle counts as it stands, around the back region turned over.
constexpr int front_role = 0, back_role = 1;

bool is_finite(Vec3 p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

/// A shared vertex as one piece has it. They meet by number, not through SharedVertices: that is what made
/// the numbers.
struct SharedPoint {
  GlobalIndex number;
  double coordinates[3];
  PieceId piece;
  LocalIndex vertex;

  static constexpr auto fields() {
    return std::tuple(&SharedPoint::number, &SharedPoint::coordinates, &SharedPoint::piece,
                      &SharedPoint::vertex);
  }
};

/// An edge is fine when, around each region, as many triangles pass it one way as the other.
std::optional<Violation> judge_edge(std::span<const Member> members) {
  std::optional<Violation> worst;
  for (const Member& first : members) {
    std::ptrdiff_t passes = 0, balance = 0;
    for (const Member& member : members) {
      if (member.label != first.label) continue;
      ++passes;
      balance += member.odd() ? 1 : -1;
    }
    if (balance != 0)
      worst = std::max(
          worst, std::optional(passes == 1 ? Violation::edge_of_one_triangle : Violation::edge_unbalanced));
  }
  return worst;
}

/// Whether every region that pieces and faces name is one of the mesh's.
bool has_known_regions(const DistributedMesh& mesh) {
  const auto known = [&](RegionId region) { return region >= 0 && region < mesh.region_count(); };
  return (mesh.sides.empty() || mesh.sides.size() == mesh.faces.size()) &&
         std::all_of(
             mesh.sides.begin(), mesh.sides.end(),
             [&](const FaceSides& s) { return known(s.front) && (known(s.back) || !s.is_inner()); }) &&
         std::all_of(mesh.pieces.begin(), mesh.pieces.end(), [&](const Piece& piece) {
           return known(piece.region) && std::all_of(piece.runs.begin(), piece.runs.end(),
                                                     [&](const auto& run) { return known(run.region); });
         });
}

/// Calls visit(region, first, last, sign) for the runs [first, last) of a piece's boundary faces that bound a
/// region, seen from its outside (sign 1) or its inside (-1).
template <class Visit>
void for_each_run(const DistributedMesh& mesh, const Piece& piece, Visit&& visit) {
  const LocalIndex count = boundary_face_count(piece);
  for (LocalIndex first = 0, last = 0; first < count; first = last) {
    const std::int32_t face = cad_face_of(piece, first);
    while (last < count && cad_face_of(piece, last) == face) ++last;
    const FaceSides sides = mesh.sides_of(face);
    visit(sides.front, first, last, 1);
    if (sides.is_inner()) visit(sides.back, first, last, -1);
  }
}

/// The centre of the box around the finite points of each region's boundary: sums taken about it lose least.
std::vector<Vec3> centers_of_regions(const DistributedMesh& mesh) {
  const parallel::Communicator& communicator = mesh.communicator;
  struct RegionBox {
    RegionId region;
    geometry::Box box;
  };
  std::vector<RegionBox> mine;
  for (const Piece& piece : mesh.pieces) {
    std::map<RegionId, geometry::Box> boxes;
    for_each_run(mesh, piece, [&](RegionId region, LocalIndex first, LocalIndex last, int) {
      geometry::Box& box = boxes[region];
      for (LocalIndex t = first; t < last; ++t) {
        for (const LocalIndex v : corners_of_boundary(piece, t)) {
          if (is_finite(piece.point(v))) box.add(piece.point(v));
        }
      }
    });
    for (const auto& [region, box] : boxes) mine.push_back({region, box});
  }
  std::vector<geometry::Box> boxes(mesh.region_count());
  for (const RegionBox& part : communicator.all_gather_items(std::span<const RegionBox>(mine))) {
    if (part.box.empty()) continue;
    boxes[part.region].add(part.box.low);
    boxes[part.region].add(part.box.high);
  }
  std::vector<Vec3> centers;
  centers.reserve(boxes.size());
  for (const geometry::Box& box : boxes) centers.push_back(box.empty() ? Vec3{} : box.center());
  return centers;
}

double cone_volume6(const Piece& piece, LocalIndex face, Vec3 apex) {
  const std::span<const LocalIndex> v = corners_of_boundary(piece, face);
  const Vec3 a = piece.point(v[0]) - apex, b = piece.point(v[1]) - apex, c = piece.point(v[2]) - apex;
  const double triangle = geometry::dot(a, geometry::cross(b, c));
  if (v.size() == 3) return triangle;
  const Vec3 d = piece.point(v[3]) - apex;
  return bilinear_cone_volume6(a, b, c, d);
}

}  // namespace

void require_checkable(const NumberedMesh& mesh, CellKind kind) {
  const parallel::Communicator& communicator = mesh.communicator;
  parallel::agree(communicator, [&] {
    if (mesh.kind != kind) throw std::logic_error("the mesh has cells of another kind");
    bool fits = mesh.numbering.vertices.size() == mesh.pieces.size();
    for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
      require_consistent_arrays(mesh.pieces[i]);
      fits = fits && mesh.pieces[i].kind == kind &&
             mesh.numbering.vertices[i].size() == static_cast<std::size_t>(mesh.pieces[i].vertex_count());
    }
    if (!fits) throw std::logic_error("the numbering does not belong to the mesh");
    if (!has_known_regions(mesh)) throw std::logic_error("the mesh has no such region");
  });
}

void check_finite_coordinates(const NumberedMesh& mesh, Findings& findings) {
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    const Piece& piece = mesh.pieces[i];
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      if (is_finite(piece.point(v))) continue;
      findings.add(Violation::coordinate_not_finite,
                   {{mesh.numbering.vertices[i][v]}, piece.id, Entity::vertex, v});
    }
  }
}

void check_orphans(const NumberedMesh& mesh, Findings& findings) {
  std::vector<std::uint8_t> used;
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    const Piece& piece = mesh.pieces[i];
    used.assign(piece.vertex_count(), 0);
    for (const auto* cells : {&piece.cells, &piece.pyramids, &piece.prisms, &piece.hexahedra}) {
      for (const LocalIndex v : *cells) used[v] = 1;
    }
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      if (used[v]) continue;
      findings.add(Violation::orphan_vertex, {{mesh.numbering.vertices[i][v]}, piece.id, Entity::vertex, v});
    }
  }
}

void check_labels(const DistributedMesh& mesh, Findings& findings) {
  const auto names = [](std::int32_t id, const std::vector<std::string>& list) {
    return id >= 0 && static_cast<std::size_t>(id) < list.size();
  };
  for (const Piece& piece : mesh.pieces) {
    for (LocalIndex f = 0; f < boundary_face_count(piece); ++f) {
      const Offender offender{{piece.id, f}, piece.id, Entity::boundary_face, f};
      if (!names(patch_of(piece, f), mesh.patches)) findings.add(Violation::triangle_without_patch, offender);
      if (!names(cad_face_of(piece, f), mesh.faces)) findings.add(Violation::triangle_without_face, offender);
    }
  }
}

void check_shared_coordinates(const NumberedMesh& mesh, Findings& findings) {
  const parallel::Communicator& communicator = mesh.communicator;
  std::vector<SharedPoint> mine;
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    const Piece& piece = mesh.pieces[i];
    for (const LocalIndex v : piece.shared_vertices) {
      const Vec3 p = piece.point(v);
      mine.push_back({mesh.numbering.vertices[i][v], {p.x, p.y, p.z}, piece.id, v});
    }
  }
  const std::vector<SharedPoint> met =
      meet_by_key(communicator, std::move(mine), &SharedPoint::number,
                  [](const SharedPoint& point) { return std::tie(point.piece, point.vertex); });
  for_each_key(met, &SharedPoint::number, [&](std::span<const SharedPoint> group) {
    for (const SharedPoint& point : group.subspan(1)) {
      if (same_bits(point.coordinates, group.front().coordinates)) continue;
      findings.add(Violation::shared_coordinates_differ,
                   {{point.number}, point.piece, Entity::vertex, point.vertex});
    }
  });
}

void check_boundary_edges(const NumberedMesh& mesh, Findings& findings) {
  const auto edges = [&](const Piece& piece, const auto& sink) {
    std::uint32_t item = 0;
    for (LocalIndex f = 0; f < boundary_face_count(piece); ++f) {
      const std::span<const LocalIndex> v = corners_of_boundary(piece, f);
      const bool inner = mesh.sides_of(cad_face_of(piece, f)).is_inner();
      for (std::size_t k = 0; k < v.size(); ++k, ++item) {
        const LocalIndex from = v[k], to = v[(k + 1) % v.size()];
        sink(std::array<LocalIndex, 2>{from, to}, front_role, item);
        if (inner) sink(std::array<LocalIndex, 2>{to, from}, back_role, item);
      }
    }
  };
  const auto region = [&](const Piece& piece, int role, std::int64_t item) {
    const FaceSides sides = mesh.sides_of(cad_face_of(piece, face_at_edge(piece, item).face));
    return role == front_role ? sides.front : sides.back;
  };
  match_all<2>(mesh, Matching{{Entity::boundary_edge, Entity::boundary_edge}, edges, region, judge_edge},
               findings);
}

void CompensatedSum::add(double term) {
  const double sum = _sum + term;
  _error += std::abs(_sum) >= std::abs(term) ? (_sum - sum) + term : (term - sum) + _sum;
  _sum = sum;
}

std::vector<double> sum_by_region(const DistributedMesh& mesh, const std::vector<RegionTerm>& terms) {
  const parallel::Communicator& communicator = mesh.communicator;
  std::vector<RegionTerm> all = communicator.gather_sorted(
      terms, [](const RegionTerm& each) { return std::tie(each.region, each.piece); });
  std::vector<CompensatedSum> sums(mesh.region_count());
  for (const RegionTerm& term : all) sums[term.region].add(term.value);
  std::vector<double> values;
  values.reserve(sums.size());
  for (const CompensatedSum& sum : sums) values.push_back(sum.value());
  return values;
}

std::vector<double> enclosed_volumes(const DistributedMesh& mesh) {
  const std::vector<Vec3> centers = centers_of_regions(mesh);
  std::vector<RegionTerm> terms;
  for (const Piece& piece : mesh.pieces) {
    std::map<RegionId, CompensatedSum> sums;
    for_each_run(mesh, piece, [&](RegionId region, LocalIndex first, LocalIndex last, int sign) {
      CompensatedSum& sum = sums[region];
      for (LocalIndex t = first; t < last; ++t) sum.add(sign * cone_volume6(piece, t, centers[region]) / 6);
    });
    for (const auto& [region, sum] : sums) terms.push_back({region, piece.id, sum.value()});
  }
  return sum_by_region(mesh, terms);
}

std::string region_prefix(const DistributedMesh& mesh, RegionId region) {
  return mesh.regions.size() > 1 ? "region '" + mesh.regions[region] + "': " : std::string();
}

}  // namespace aeroloom::mesh
