#include "improve/borders/rounds.hpp"

#include "geometry/runs.hpp"
#include "geometry/sort_unique.hpp"
#include "improve/borders/claims.hpp"
#include "improve/borders/piece_assignment.hpp"
#include "improve/borders/piece_update.hpp"
#include "mesh/data/mixing.hpp"
#include "mesh/data/shared_vertex_keys.hpp"
#include "mesh/exchange/delivery.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/communication/schedule.hpp"
#include "parallel/observation/timers.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace aeroloom::cavities {
namespace {

/// What happened to a cavity; equal on all ranks.
struct Outcome {
  CavityId cavity;
  std::int32_t replaced;  ///< 0: it stays as it was
  std::int32_t added;     ///< vertices
};

/// The names of a piece's vertices in this round.
std::vector<mesh::SharedVertexKey> vertex_keys_of(const mesh::Piece& piece, int round) {
  std::vector<mesh::SharedVertexKey> vertex_keys(piece.vertex_count());
  for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v)
    vertex_keys[v] = mesh::late_key(round, piece.id, v);
  for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s)
    vertex_keys[piece.shared_vertices[s]] = piece.shared_keys[s];
  return vertex_keys;
}

std::array<mesh::LocalIndex, 3> sorted(std::array<mesh::LocalIndex, 3> v) {
  std::sort(v.begin(), v.end());
  return v;
}

/// Tetrahedra of cavities on their way between ranks, with their vertices and triangles of the surface mesh.
struct WireParts {
  std::vector<WireTet> tets;
  std::vector<WireVertex> vertices;
  std::vector<WireTriangle> triangles;
};

/// Sends each item to the rank that `rank_of` gives. Vertices and triangles arrive by cavity, then by key,
/// tetrahedra by the rank that sent them. Collective.
template <class RankOf>
WireParts deliver(const mesh::DistributedMesh& mesh, WireParts parts, const RankOf& rank_of) {
  WireParts in{mesh::deliver(mesh.communicator, std::move(parts.tets), rank_of),
               mesh::deliver(mesh.communicator, std::move(parts.vertices), rank_of),
               mesh::deliver(mesh.communicator, std::move(parts.triangles), rank_of)};
  std::sort(in.vertices.begin(), in.vertices.end(), [](const WireVertex& a, const WireVertex& b) {
    return a.cavity != b.cavity ? a.cavity < b.cavity : a.vertex_key < b.vertex_key;
  });
  std::sort(in.triangles.begin(), in.triangles.end(), [](const WireTriangle& a, const WireTriangle& b) {
    return a.cavity != b.cavity ? a.cavity < b.cavity : a.vertices < b.vertices;
  });
  return in;
}

/// The tetrahedra that this rank's pieces give to cavities.
struct Contribution {
  WireParts parts;
  std::vector<std::vector<CavityId>> of_cell;                   ///< per local piece, per cell
  std::vector<std::vector<CavityId>> of_triangle;               ///< per local piece, per boundary triangle
  std::vector<std::vector<mesh::SharedVertexKey>> vertex_keys;  ///< per local piece, per vertex
};

/// The boundary triangles of a piece whose tetrahedron is in a cavity: of those at a baffle triangle the one
/// that it is seen from outside of.
void mark_triangles(const mesh::Piece& piece, const std::vector<CavityId>& of_cell,
                    std::vector<CavityId>& of_triangle) {
  struct Face {
    std::array<mesh::LocalIndex, 3> vertices;
    bool odd;
    CavityId cavity;
  };
  const auto face_of = [](mesh::LocalIndex a, mesh::LocalIndex b, mesh::LocalIndex c, CavityId cavity) {
    const std::array<mesh::LocalIndex, 3> vertices = sorted({a, b, c});
    const bool odd = std::array{b, c} != std::array{vertices[1], vertices[2]} &&
                     std::array{c, a} != std::array{vertices[1], vertices[2]} &&
                     std::array{a, b} != std::array{vertices[1], vertices[2]};
    return Face{vertices, odd, cavity};
  };
  std::vector<char> on_boundary(piece.vertex_count(), 0);
  for (const mesh::LocalIndex v : piece.boundary) on_boundary[v] = 1;
  std::vector<Face> faces;
  for (mesh::LocalIndex c = 0; c < piece.cell_count(); ++c) {
    if (of_cell[c] == no_cavity) continue;
    for (const auto& f : mesh::tetrahedron_faces) {
      const mesh::LocalIndex* v = piece.cell(c);
      if (!on_boundary[v[f[0]]] || !on_boundary[v[f[1]]] || !on_boundary[v[f[2]]]) continue;
      faces.push_back(face_of(v[f[0]], v[f[1]], v[f[2]], of_cell[c]));
    }
  }
  const auto less = [](const Face& a, const Face& b) {
    return a.vertices != b.vertices ? a.vertices < b.vertices : a.odd < b.odd;
  };
  std::sort(faces.begin(), faces.end(), less);
  of_triangle.assign(piece.boundary_count(), no_cavity);
  for (mesh::LocalIndex t = 0; t < piece.boundary_count(); ++t) {
    const mesh::LocalIndex* v = piece.boundary_triangle(t);
    const Face wanted = face_of(v[0], v[1], v[2], no_cavity);
    const auto at = std::lower_bound(faces.begin(), faces.end(), wanted, less);
    if (at != faces.end() && !less(wanted, *at)) of_triangle[t] = at->cavity;
  }
}

/// A cavity lies in one region: a claim on the face between two makes one on either side.
CavityId within_region(CavityId claim, mesh::RegionId region) {
  const CavityId id = mesh::mix_in(claim, static_cast<std::uint64_t>(region));
  return id == no_cavity ? CavityId{1} : id;
}

Contribution collect(const mesh::DistributedMesh& mesh, const CavityClaims& claims, int round) {
  Contribution result;
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const mesh::Piece& piece = mesh.pieces[p];
    const std::vector<mesh::SharedVertexKey>& vertex_key =
        result.vertex_keys.emplace_back(vertex_keys_of(piece, round));
    std::vector<CavityId>& of_cell = result.of_cell.emplace_back(piece.cell_count(), no_cavity);
    std::vector<std::pair<CavityId, mesh::LocalIndex>> used;
    for (mesh::LocalIndex c = 0; c < piece.cell_count(); ++c) {
      const mesh::LocalIndex* v = piece.cell(c);
      const CavityId claim = cavity_of(claims[p], v, 4);
      if (claim == no_cavity) continue;
      of_cell[c] = within_region(claim, piece.region);
      result.parts.tets.push_back({of_cell[c],
                                   piece.id,
                                   piece.region,
                                   {vertex_key[v[0]], vertex_key[v[1]], vertex_key[v[2]], vertex_key[v[3]]}});
      for (int k = 0; k < 4; ++k) used.push_back({of_cell[c], v[k]});
    }
    geometry::sort_unique(used);
    for (const auto& [cavity, v] : used)
      result.parts.vertices.push_back({cavity, piece.id, static_cast<std::int32_t>(piece.vertex_dimension[v]),
                                       vertex_key[v], piece.point(v), piece.vertex_entity[v],
                                       piece.surface_numbers.empty() ? -1 : piece.surface_numbers[v]});
    mark_triangles(piece, of_cell, result.of_triangle.emplace_back());
    for (mesh::LocalIndex t = 0; t < piece.boundary_count(); ++t) {
      const CavityId cavity = result.of_triangle.back()[t];
      if (cavity == no_cavity) continue;
      const mesh::LocalIndex* v = piece.boundary_triangle(t);
      result.parts.triangles.push_back({cavity,
                                        piece.id,
                                        piece.triangle_face[t],
                                        {vertex_key[v[0]], vertex_key[v[1]], vertex_key[v[2]]},
                                        piece.triangle_patch[t]});
    }
  }
  return result;
}

/// The cavities of all ranks with their sizes, ascending, the same on every rank.
struct CavityTable {
  std::vector<CavityId> ids;
  std::vector<double> loads;
  std::vector<parallel::Rank> owners;

  std::size_t slot(CavityId id) const {
    return static_cast<std::size_t>(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin());
  }
  parallel::Rank owner(CavityId id) const { return owners[slot(id)]; }
};

CavityTable list_cavities(const mesh::DistributedMesh& mesh, const std::vector<WireTet>& tets) {
  struct CavitySize {
    CavityId cavity;
    std::int64_t tets;
  };
  std::vector<CavityId> all;
  all.reserve(tets.size());
  for (const WireTet& t : tets) all.push_back(t.cavity);
  std::sort(all.begin(), all.end());
  std::vector<CavitySize> rows;
  geometry::for_each_run(std::span<const CavityId>(all), std::equal_to<>{},
                         [&](std::size_t first, std::size_t last) {
                           rows.push_back({all[first], static_cast<std::int64_t>(last - first)});
                         });
  const std::vector<CavitySize> table = mesh.communicator.gather_sorted(rows, &CavitySize::cavity);
  CavityTable result;
  for (const CavitySize& row : table) {
    if (result.ids.empty() || result.ids.back() != row.cavity) {
      result.ids.push_back(row.cavity);
      result.loads.push_back(0);
    }
    result.loads.back() += static_cast<double>(row.tets);
  }
  result.owners = parallel::assign_largest_first(result.loads, mesh.communicator.size());
  return result;
}

/// A cavity on the rank that replaces it.
struct OwnedCavity {
  Cavity cavity;
  std::vector<mesh::SharedVertexKey> vertex_keys;  ///< per point, ascending
  std::vector<mesh::GlobalIndex> surface_numbers;  ///< per point
  std::vector<mesh::PieceId> donor;                ///< per tetrahedron: the piece it comes from
  std::optional<CavityContent> content;
  CavityAssignment assignment;  ///< of the content
};

std::vector<OwnedCavity> assemble(const mesh::DistributedMesh& mesh, WireParts parts) {
  const CavityTable table = list_cavities(mesh, parts.tets);
  auto [tets, vertices, triangles] =
      deliver(mesh, std::move(parts), [&](const auto& item) { return table.owner(item.cavity); });
  // Tetrahedra keep their order within a piece, so that it does not depend on ranks.
  std::stable_sort(tets.begin(), tets.end(), [](const WireTet& a, const WireTet& b) {
    return a.cavity != b.cavity ? a.cavity < b.cavity : a.piece < b.piece;
  });
  std::vector<OwnedCavity> cavities;
  std::size_t v = 0, s = 0;
  for (std::size_t i = 0, j = 0; i < tets.size(); i = j) {
    OwnedCavity& owned = cavities.emplace_back();
    owned.cavity.id = tets[i].cavity;
    owned.cavity.region = tets[i].region;
    for (; v < vertices.size() && vertices[v].cavity == owned.cavity.id; ++v) {
      if (!owned.vertex_keys.empty() && owned.vertex_keys.back() == vertices[v].vertex_key) continue;
      owned.vertex_keys.push_back(vertices[v].vertex_key);
      owned.surface_numbers.push_back(vertices[v].surface_number);
      owned.cavity.entity.push_back(vertices[v].entity);
      owned.cavity.points.push_back(vertices[v].point);
      owned.cavity.dimension.push_back(static_cast<mesh::CadDimension>(vertices[v].dimension));
    }
    const auto local = [&](mesh::SharedVertexKey vertex_key) {
      return static_cast<mesh::LocalIndex>(
          std::lower_bound(owned.vertex_keys.begin(), owned.vertex_keys.end(), vertex_key) -
          owned.vertex_keys.begin());
    };
    for (; j < tets.size() && tets[j].cavity == owned.cavity.id; ++j) {
      const auto& w = tets[j].vertices;
      owned.cavity.tets.push_back({local(w[0]), local(w[1]), local(w[2]), local(w[3])});
      owned.donor.push_back(tets[j].piece);
    }
    for (; s < triangles.size() && triangles[s].cavity == owned.cavity.id; ++s) {
      const auto& w = triangles[s].vertices;
      owned.cavity.triangles.push_back(
          {{local(w[0]), local(w[1]), local(w[2])}, triangles[s].face, triangles[s].patch});
    }
  }
  return cavities;
}

/// Adds a replaced cavity. `first_added` is the number of its first new vertex among those of the round.
void pack_replaced(const OwnedCavity& owned, int round, std::int64_t first_added, WireParts& out) {
  const CavityId id = owned.cavity.id;
  const auto known = static_cast<mesh::LocalIndex>(owned.vertex_keys.size());
  const auto vertex_key = [&](mesh::LocalIndex v) {
    return v < known ? owned.vertex_keys[v] : mesh::placed_key(round, first_added + (v - known));
  };
  const CavityAssignment& assignment = owned.assignment;
  std::vector<std::pair<mesh::PieceId, mesh::LocalIndex>> uses;
  for (std::size_t i = 0; i < owned.content->tets.size(); ++i) {
    const auto& t = owned.content->tets[i];
    out.tets.push_back({id,
                        assignment.of_tet[i],
                        owned.cavity.region,
                        {vertex_key(t[0]), vertex_key(t[1]), vertex_key(t[2]), vertex_key(t[3])}});
    for (const mesh::LocalIndex v : t) uses.emplace_back(assignment.of_tet[i], v);
  }
  geometry::sort_unique(uses);
  for (const auto& [piece, v] : uses) {
    if (v < known) {
      out.vertices.push_back({id, piece, static_cast<std::int32_t>(owned.cavity.dimension[v]),
                              owned.vertex_keys[v], owned.cavity.points[v], owned.cavity.entity[v],
                              owned.surface_numbers[v]});
    } else {
      const AddedVertex& added = owned.content->added[v - known];
      out.vertices.push_back(
          {id, piece, static_cast<std::int32_t>(added.dimension), vertex_key(v), added.point,
           added.dimension == mesh::CadDimension::region ? owned.cavity.region : added.entity, -1});
    }
  }
  const std::vector<CavityTriangle>& triangles = owned.content->triangles_of(owned.cavity);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const CavityTriangle& t = triangles[i];
    out.triangles.push_back(
        {id,
         assignment.of_triangle[i],
         t.face,
         {vertex_key(t.vertices[0]), vertex_key(t.vertices[1]), vertex_key(t.vertices[2])},
         t.patch});
  }
}

/// Brings replaced cavities to the pieces that take their tetrahedra. Collective.
WireParts deliver_replaced(const mesh::DistributedMesh& mesh, const std::vector<OwnedCavity>& cavities,
                           const std::vector<Outcome>& outcomes, int round) {
  const std::vector<parallel::Rank> here(mesh.pieces.size(), mesh.communicator.rank());
  const std::vector<parallel::Rank> owner_of_piece = mesh::gather_by_piece(mesh, here);
  WireParts out;
  std::int64_t first_new = 0;
  std::size_t next = 0;
  for (const Outcome& outcome : outcomes) {  // ascending, as the cavities of this rank
    const std::int64_t first = first_new;
    first_new += outcome.added;
    if (next >= cavities.size() || cavities[next].cavity.id != outcome.cavity) continue;
    const OwnedCavity& owned = cavities[next++];
    if (owned.content) pack_replaced(owned, round, first, out);
  }
  WireParts in = deliver(mesh, std::move(out), [&](const auto& item) { return owner_of_piece[item.piece]; });
  std::stable_sort(in.tets.begin(), in.tets.end(), [](const WireTet& a, const WireTet& b) {
    return a.piece != b.piece ? a.piece < b.piece : a.cavity < b.cavity;
  });
  return in;
}

std::vector<PieceChange> update_pieces(mesh::DistributedMesh& mesh, const Contribution& mine,
                                       const std::vector<Outcome>& outcomes, const WireParts& delivery) {
  const auto gone = [&](CavityId id) {
    const auto is_before = [](const Outcome& o, CavityId c) { return o.cavity < c; };
    return id != no_cavity && std::lower_bound(outcomes.begin(), outcomes.end(), id, is_before)->replaced;
  };
  std::vector<std::vector<WireTriangle>> triangles(mesh.pieces.size());
  std::vector<std::vector<WireVertex>> vertices(mesh.pieces.size());
  for (const WireVertex& v : delivery.vertices) vertices[mesh::position_of(mesh, v.piece)].push_back(v);
  for (const WireTriangle& t : delivery.triangles) triangles[mesh::position_of(mesh, t.piece)].push_back(t);
  std::vector<PieceChange> changes(mesh.pieces.size());
  std::size_t first = 0;
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    mesh::Piece& piece = mesh.pieces[p];
    PieceChange& change = changes[p];
    std::size_t last = first;
    while (last < delivery.tets.size() && delivery.tets[last].piece == piece.id) ++last;
    const bool touched = last > first || std::any_of(mine.of_cell[p].begin(), mine.of_cell[p].end(), gone);
    change.first_new = piece.cell_count();
    if (touched) {
      PieceUpdate update(piece, mine.vertex_keys[p]);
      for (mesh::LocalIndex c = 0; c < piece.cell_count(); ++c) {
        if (gone(mine.of_cell[p][c])) {
          update.leave(c);
          change.left.push_back(c);
        } else {
          update.keep(c);
        }
      }
      for (mesh::LocalIndex t = 0; t < piece.boundary_count(); ++t) {
        if (!gone(mine.of_triangle[p][t])) update.keep_triangle(t);
      }
      change.first_new -= static_cast<mesh::LocalIndex>(change.left.size());
      piece = update.finish({delivery.tets.data() + first, last - first}, vertices[p], triangles[p]);
    }
    first = last;
  }
  return changes;
}

}  // namespace

CavityRound replace_cavities(mesh::DistributedMesh& mesh, const mesh::SharedVertices& shared,
                             const ReplacementRequest& request) {
  const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
  const int round = mesh.cavity_rounds++;
  if (round >= mesh::most_key_rounds) throw std::logic_error("replace_cavities: too many rounds");
  CavityClaims uncontested = request.claims;
  shared.combine(uncontested, [](CavityId a, CavityId b) { return std::max(a, b); });  // the same for all
  withdraw_contested_claims(mesh, shared, uncontested);
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    for (int ring = 0; ring < request.extent.rings; ++ring)
      widen(mesh.pieces[p], request.extent.along_surface, uncontested[p]);
  }
  Contribution mine = collect(mesh, uncontested, round);
  std::vector<OwnedCavity> cavities = assemble(mesh, std::move(mine.parts));
  std::vector<Outcome> outcomes;
  parallel::agree(mesh.communicator, [&] {
    for (OwnedCavity& owned : cavities) {
      owned.content = request.replace(owned.cavity);
      if (owned.content) owned.assignment = assign_to_pieces(owned.cavity, owned.donor, *owned.content);
      const auto added = owned.content ? static_cast<std::int32_t>(owned.content->added.size()) : 0;
      outcomes.push_back({owned.cavity.id, owned.content ? 1 : 0, added});
    }
  });
  outcomes = mesh.communicator.gather_sorted(outcomes, &Outcome::cavity);
  const WireParts delivery = deliver_replaced(mesh, cavities, outcomes, round);
  CavityRound result;
  result.changes = update_pieces(mesh, mine, outcomes, delivery);
  result.cavities = static_cast<std::int64_t>(outcomes.size());
  for (const Outcome& outcome : outcomes) result.replaced += outcome.replaced;
  return result;
}

}  // namespace aeroloom::cavities
