#include "pipeline/erase_interfaces.hpp"

#include "mesh/cavities.hpp"
#include "mesh/delivery.hpp"
#include "mesh/findings.hpp"
#include "mesh/mixing.hpp"
#include "mesh/quality.hpp"
#include "mesh/tet_faces.hpp"

#include <algorithm>
#include <cmath>

namespace aeroloom::pipeline {
namespace {

using geometry::Vec3;
using mesh::Cavity;
using mesh::CavityId;
using mesh::CavityRound;
using mesh::CavityWishes;
using mesh::LocalIndex;
using mesh::no_cavity;
using mesh::Piece;
using mesh::Refilling;

constexpr int most_rounds = 10;
/// Width of a cell of the grid, in local sizes, at least.
constexpr double cell_width = 8;
/// Mean ratio of the tetrahedra around a vertex, on average: 0.95 in the lattice, 0.90 where a point of it is
/// missing.
constexpr double decent_star = 0.87;
/// Tokens above this are not those of interfaces: vertices of pieces that became shared later.
constexpr mesh::SharedToken last_token = mesh::SharedToken{1} << 62;

/// The closed boundary of a cavity.
struct Shell {
  volume::ClosedSurface surface;
  std::vector<LocalIndex> vertex;  ///< of the cavity, per point
};

Shell shell_of(const Cavity& cavity) {
  const std::vector<mesh::TetFace> faces = mesh::boundary_faces(cavity.tets);
  std::vector<LocalIndex> local(cavity.points.size(), -1);
  for (const mesh::TetFace& face : faces) {
    for (const LocalIndex v : face.vertices) local[v] = 0;
  }
  Shell shell;
  for (std::size_t v = 0; v < local.size(); ++v) {
    if (local[v] < 0) continue;
    local[v] = static_cast<LocalIndex>(shell.vertex.size());
    shell.vertex.push_back(static_cast<LocalIndex>(v));
    shell.surface.points.push_back(cavity.points[v]);
  }
  for (const mesh::TetFace& face : faces) {
    const auto& v = face.vertices;
    shell.surface.triangles.push_back({local[v[0]], local[v[1]], local[v[2]]});
    shell.surface.continued.push_back(
        std::any_of(v.begin(), v.end(), [&](LocalIndex w) { return cavity.dimension[w] == 3; }));
  }
  return shell;
}

/// Fills the cavity anew with the lattice; nothing when that does not work.
std::optional<Refilling> refill(const Cavity& cavity, const sizing::SizeField& field,
                                const volume::VolumeOptions& options, parallel::StageClock& clock) {
  const Shell shell = shell_of(cavity);
  volume::FilledVolume filled;
  try {
    filled = volume::fill_volume(shell.surface, field, options);
  } catch (const volume::VolumeError&) {
    return std::nullopt;
  }
  clock.add_task_cpu(filled.cpu_seconds);
  clock.note_child_memory(filled.child_peak_bytes);
  Refilling result;
  const auto known = static_cast<LocalIndex>(shell.vertex.size());
  const auto all = static_cast<LocalIndex>(cavity.points.size());
  for (std::size_t i = 3 * shell.vertex.size(); i < filled.coordinates.size(); i += 3)
    result.added.push_back({{filled.coordinates[i], filled.coordinates[i + 1], filled.coordinates[i + 2]}});
  for (std::size_t i = 0; i < filled.tetrahedra.size(); i += 4) {
    auto& tet = result.tets.emplace_back();
    for (int k = 0; k < 4; ++k) {
      const LocalIndex v = filled.tetrahedra[i + k];
      tet[k] = v < known ? shell.vertex[v] : all + (v - known);
    }
  }
  return result;
}

/// Calls visit(piece index, vertex, token) for the vertices of interfaces.
template <class Visit>
void for_each_interface_vertex(const mesh::DistributedMesh& mesh, mesh::SharedToken first_token,
                               const Visit& visit) {
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const Piece& piece = mesh.pieces[p];
    for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s) {
      const mesh::SharedToken token = piece.shared_tokens[s];
      if (token >= first_token && token < last_token) visit(p, piece.shared_vertices[s], token);
    }
  }
}

CavityWishes no_wishes(const mesh::DistributedMesh& mesh) {
  CavityWishes wishes;
  for (const Piece& piece : mesh.pieces) wishes.emplace_back(piece.vertex_count(), no_cavity);
  return wishes;
}

/// Vertices that just two pieces share wish for the cavity between these two.
CavityWishes wish_by_pieces(const parallel::Communicator& communicator, const mesh::DistributedMesh& mesh,
                            mesh::SharedToken first_token) {
  struct Share {
    mesh::SharedToken token;
    mesh::PieceId piece;
    parallel::Rank rank;
    CavityId cavity;
  };
  std::vector<Share> mine;
  for_each_interface_vertex(mesh, first_token, [&](std::size_t p, LocalIndex, mesh::SharedToken token) {
    mine.push_back({token, mesh.pieces[p].id, communicator.rank(), no_cavity});
  });
  std::vector<Share> met = mesh::deliver(communicator, mine, [&](const Share& s) {
    return mesh::meeting_rank(mesh::mix_in(0, s.token), communicator.size());
  });
  std::sort(met.begin(), met.end(), [](const Share& a, const Share& b) {
    return a.token != b.token ? a.token < b.token : a.piece < b.piece;
  });
  std::vector<Share> answers;
  for (std::size_t i = 0, j = 0; i < met.size(); i = j) {
    while (j < met.size() && met[j].token == met[i].token) ++j;
    if (j - i != 2) continue;
    const CavityId id =
        mesh::mix_in(static_cast<std::uint64_t>(met[i].piece), static_cast<std::uint64_t>(met[i + 1].piece));
    for (std::size_t k = i; k < j; ++k) {
      answers.push_back(met[k]);
      answers.back().cavity = id == no_cavity ? CavityId{1} : id;
    }
  }
  std::vector<Share> arrived = mesh::deliver(communicator, answers, [](const Share& s) { return s.rank; });
  const auto less = [](const Share& a, const Share& b) {
    return a.piece != b.piece ? a.piece < b.piece : a.token < b.token;
  };
  std::sort(arrived.begin(), arrived.end(), less);
  CavityWishes wishes = no_wishes(mesh);
  for_each_interface_vertex(mesh, first_token, [&](std::size_t p, LocalIndex v, mesh::SharedToken token) {
    const Share wanted{token, mesh.pieces[p].id, 0, no_cavity};
    const auto at = std::lower_bound(arrived.begin(), arrived.end(), wanted, less);
    if (at != arrived.end() && at->token == token && at->piece == wanted.piece) wishes[p][v] = at->cavity;
  });
  return wishes;
}

/// Vertices wish for the cavity of the grid's cell that they are in.
CavityWishes wish_by_place(const mesh::DistributedMesh& mesh, mesh::SharedToken first_token,
                           const sizing::SizeField& field, int round) {
  CavityWishes wishes = no_wishes(mesh);
  for_each_interface_vertex(mesh, first_token, [&](std::size_t p, LocalIndex v, mesh::SharedToken) {
    const Vec3 x = mesh.pieces[p].point(v);
    wishes[p][v] = mesh::cavity_at(x, field(x), cell_width, round);
  });
  return wishes;
}

/// Vertices of refilled places whose tetrahedra are poor wish for the cavity of the grid's cell that they are
/// in: where cavities met, the lattice may miss a point.
CavityWishes wish_by_shape(const mesh::DistributedMesh& mesh, const sizing::SizeField& field, int round) {
  CavityWishes wishes = no_wishes(mesh);
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const Piece& piece = mesh.pieces[p];
    std::vector<double> sum(piece.vertex_count(), 0);
    std::vector<std::int32_t> count(piece.vertex_count(), 0);
    for (LocalIndex c = 0; c < piece.cell_count(); ++c) {
      const LocalIndex* v = piece.cell(c);
      const double ratio =
          mesh::mean_ratio(piece.point(v[0]), piece.point(v[1]), piece.point(v[2]), piece.point(v[3]));
      for (int k = 0; k < 4; ++k) sum[v[k]] += ratio, ++count[v[k]];
    }
    for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s) {
      const LocalIndex v = piece.shared_vertices[s];
      if (piece.vertex_dimension[v] == 3 && count[v] > 0 && sum[v] < decent_star * count[v])
        wishes[p][v] = mesh::cavity_at(piece.point(v), field(piece.point(v)), cell_width, round);
    }
  }
  return wishes;
}

/// Vertices of interfaces left, those that pieces share counted as often.
std::int64_t count_left(const parallel::Communicator& communicator, const mesh::DistributedMesh& mesh,
                        mesh::SharedToken first_token) {
  std::int64_t count = 0;
  for_each_interface_vertex(mesh, first_token, [&](std::size_t, LocalIndex, mesh::SharedToken) { ++count; });
  return communicator.sum(count);
}

void measure(const parallel::Communicator& communicator, const mesh::DistributedMesh& mesh,
             ErasureReport& report) {
  double sums[2] = {0, 0};
  std::int64_t counts[2] = {0, 0};
  for (const Piece& piece : mesh.pieces) {
    std::vector<char> placed(piece.vertex_count(), 0);
    for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s)
      placed[piece.shared_vertices[s]] = mesh::is_placed_by_refilling(piece.shared_tokens[s]);
    for (LocalIndex c = 0; c < piece.cell_count(); ++c) {
      const LocalIndex* v = piece.cell(c);
      if (std::any_of(v, v + 4, [&](LocalIndex w) { return piece.vertex_dimension[w] < 3; })) continue;
      const int kind = std::any_of(v, v + 4, [&](LocalIndex w) { return placed[w]; }) ? 0 : 1;
      sums[kind] +=
          mesh::mean_ratio(piece.point(v[0]), piece.point(v[1]), piece.point(v[2]), piece.point(v[3]));
      ++counts[kind];
    }
  }
  for (int kind = 0; kind < 2; ++kind) {
    const double mean = communicator.sum(sums[kind]) /
                        static_cast<double>(std::max<std::int64_t>(1, communicator.sum(counts[kind])));
    (kind == 0 ? report.mean_ratio_refilled : report.mean_ratio_elsewhere) = mean;
  }
}

}  // namespace

ErasureReport erase_interfaces(const parallel::Communicator& communicator, mesh::DistributedMesh& mesh,
                               mesh::SharedToken first_token, const sizing::SizeField& field,
                               const volume::VolumeOptions& options, parallel::StageClock& clock) {
  ErasureReport report;
  volume::VolumeOptions once = options;
  once.retries = 1;
  once.sabotage = volume::VolumeOptions::Sabotage::none;  // it is meant for the pieces
  report.vertices_before = report.vertices_left = count_left(communicator, mesh, first_token);
  const auto refill_round = [&](const CavityWishes& wishes) {
    const CavityRound done = refill_cavities(
        communicator, mesh, wishes, [&](const Cavity& cavity) { return refill(cavity, field, once, clock); },
        clock);
    ++report.rounds;
    report.cavities += done.cavities;
    report.refilled += done.refilled;
  };
  while (report.rounds < most_rounds && report.vertices_left > 0) {
    refill_round(report.rounds == 0 ? wish_by_pieces(communicator, mesh, first_token)
                                    : wish_by_place(mesh, first_token, field, report.rounds));
    report.vertices_left = count_left(communicator, mesh, first_token);
  }
  if (report.rounds > 0) refill_round(wish_by_shape(mesh, field, report.rounds));
  measure(communicator, mesh, report);
  return report;
}

}  // namespace aeroloom::pipeline
