#include "cavities/wishes.hpp"

#include "mesh/delivery.hpp"
#include "mesh/findings.hpp"
#include "mesh/mixing.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace aeroloom::cavities {
namespace {

using geometry::Vec3;

/// A wish, or a refusal, for a shared vertex on its way to the other pieces.
struct Voice {
  mesh::SharedToken token;
  CavityId wish;
  parallel::Rank rank;
  std::int32_t refused;
};

/// Brings together what the pieces say of each shared vertex: `mine` has a row per piece and vertex. The
/// answers are for the vertices on this rank that anyone has a wish or a refusal for, by token: the highest
/// wish, and whether anyone refused.
std::vector<Voice> agree_on(const parallel::Communicator& communicator, std::vector<Voice> mine) {
  std::vector<Voice> met = mesh::deliver(communicator, std::move(mine), [&](const Voice& v) {
    return mesh::meeting_rank(mesh::mix_in(0, v.token), communicator.size());
  });
  std::sort(met.begin(), met.end(), [](const Voice& a, const Voice& b) {
    return a.token != b.token ? a.token < b.token : a.rank < b.rank;
  });
  std::vector<Voice> answers;
  for (std::size_t i = 0, j = 0; i < met.size(); i = j) {
    Voice all{met[i].token, no_cavity, 0, 0};
    for (; j < met.size() && met[j].token == met[i].token; ++j) {
      all.wish = std::max(all.wish, met[j].wish);
      all.refused = all.refused || met[j].refused;
    }
    if (all.wish == no_cavity && !all.refused) continue;
    for (std::size_t k = i; k < j; ++k) {
      if (k > i && met[k].rank == met[k - 1].rank) continue;
      all.rank = met[k].rank;
      answers.push_back(all);
    }
  }
  std::vector<Voice> arrived =
      mesh::deliver(communicator, std::move(answers), [](const Voice& v) { return v.rank; });
  std::sort(arrived.begin(), arrived.end(), [](const Voice& a, const Voice& b) { return a.token < b.token; });
  return arrived;
}

const Voice* find_answer(const std::vector<Voice>& answers, mesh::SharedToken token) {
  const auto at = std::lower_bound(answers.begin(), answers.end(), token,
                                   [](const Voice& v, mesh::SharedToken t) { return v.token < t; });
  return at != answers.end() && at->token == token ? &*at : nullptr;
}

/// 1 for the vertices of tetrahedra that different cavities wish for.
std::vector<char> find_contested(const mesh::Piece& piece, const std::vector<CavityId>& wishes) {
  std::vector<char> contested(piece.vertex_count(), 0);
  for (mesh::LocalIndex c = 0; c < piece.cell_count(); ++c) {
    const mesh::LocalIndex* v = piece.cell(c);
    CavityId met = no_cavity;
    bool several = false;
    for (int k = 0; k < 4; ++k) {
      if (wishes[v[k]] == no_cavity) continue;
      several = several || (met != no_cavity && met != wishes[v[k]]);
      met = wishes[v[k]];
    }
    for (int k = 0; several && k < 4; ++k) contested[v[k]] = 1;
  }
  return contested;
}

}  // namespace

CavityId cavity_at(Vec3 p, double size, double width, int shift) {
  // Far from each other in every direction, so that few places are at borders twice.
  constexpr double step[3] = {0.5, 0.382, 0.618}, level_step = 0.38;
  const double level = std::floor(std::log2(width * size) / 3 + level_step * shift);
  const double edge = std::exp2(3 * (level + 1 - level_step * shift));
  const auto bits = [](double whole) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(whole)); };
  std::uint64_t id = mesh::mix_in(static_cast<std::uint64_t>(shift), bits(level));
  for (int axis = 0; axis < 3; ++axis)
    id = mesh::mix_in(id, bits(std::floor(p[axis] / edge + shift * step[axis])));
  return id == no_cavity ? CavityId{1} : id;
}

void spread_wishes(const parallel::Communicator& communicator, const mesh::DistributedMesh& mesh,
                   CavityWishes& wishes) {
  std::vector<Voice> voices;
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const mesh::Piece& piece = mesh.pieces[p];
    for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s)
      voices.push_back({piece.shared_tokens[s], wishes[p][piece.shared_vertices[s]], communicator.rank(), 0});
  }
  const std::vector<Voice> answers = agree_on(communicator, std::move(voices));
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const mesh::Piece& piece = mesh.pieces[p];
    for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s) {
      if (const Voice* answer = find_answer(answers, piece.shared_tokens[s]))
        wishes[p][piece.shared_vertices[s]] = answer->wish;
    }
  }
}

void settle_wishes(const parallel::Communicator& communicator, const mesh::DistributedMesh& mesh,
                   CavityWishes& wishes) {
  std::vector<Voice> voices;
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const mesh::Piece& piece = mesh.pieces[p];
    const std::vector<char> contested = find_contested(piece, wishes[p]);
    for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s) {
      const mesh::LocalIndex v = piece.shared_vertices[s];
      if (wishes[p][v] != no_cavity)
        voices.push_back({piece.shared_tokens[s], wishes[p][v], communicator.rank(), contested[v]});
    }
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      if (contested[v]) wishes[p][v] = no_cavity;
    }
  }
  const std::vector<Voice> answers = agree_on(communicator, std::move(voices));
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const mesh::Piece& piece = mesh.pieces[p];
    for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s) {
      const Voice* answer = find_answer(answers, piece.shared_tokens[s]);
      if (answer && answer->refused) wishes[p][piece.shared_vertices[s]] = no_cavity;
    }
  }
}

void widen(const mesh::Piece& piece, bool along_surface, std::vector<CavityId>& wishes) {
  std::vector<char> barred(piece.vertex_count(), 0);
  for (const mesh::LocalIndex v : piece.shared_vertices) barred[v] = 1;
  for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) {
    if ((piece.vertex_dimension[v] < 3 && !along_surface) || wishes[v] != no_cavity) barred[v] = 1;
  }
  std::vector<CavityId> next(piece.vertex_count(), no_cavity);
  for (mesh::LocalIndex c = 0; c < piece.cell_count(); ++c) {
    const mesh::LocalIndex* v = piece.cell(c);
    const CavityId cavity = cavity_of(wishes, v, 4);
    if (cavity == no_cavity) continue;
    for (int k = 0; k < 4; ++k) {
      if (barred[v[k]]) continue;
      if (next[v[k]] == no_cavity) next[v[k]] = cavity;
      if (next[v[k]] != cavity) barred[v[k]] = 1, next[v[k]] = no_cavity;
    }
  }
  for (mesh::LocalIndex c = 0; c < piece.cell_count(); ++c) {
    const mesh::LocalIndex* v = piece.cell(c);
    const CavityId settled = cavity_of(wishes, v, 4), cavity = cavity_of(next, v, 4);
    if (cavity == no_cavity) continue;
    for (int k = 0; k < 4; ++k) {
      const CavityId other = next[v[k]];
      if (other == no_cavity || (other == cavity && (settled == no_cavity || settled == other))) continue;
      for (int i = 0; i < 4; ++i) barred[v[i]] = 1;
    }
  }
  for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) {
    if (!barred[v]) wishes[v] = next[v];
  }
}

}  // namespace aeroloom::cavities
