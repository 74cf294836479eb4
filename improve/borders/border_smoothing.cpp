#include "improve/borders/border_smoothing.hpp"

#include "improve/limits/examination.hpp"
#include "improve/operations/inverse_ratios.hpp"
#include "improve/operations/mean_ratio_smoothing.hpp"
#include "mesh/data/mixing.hpp"
#include "mesh/quality/quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>
#include <vector>

namespace aeroloom::improve {
namespace {

using mesh::Piece;
using mesh::SharedVertexKey;

constexpr int group_count = 2;
/// Steps that are tried at once: the wanted one, its half, its quarter.
constexpr int trial_count = 3;

int group_of(SharedVertexKey vertex_key) {
  return static_cast<int>(mesh::mix_in(1, vertex_key) % group_count);
}

/// Sums over the tetrahedra around a vertex at its present place, of a piece or of all together.
struct VertexState {
  mesh::PieceId first = std::numeric_limits<mesh::PieceId>::max();  ///< the lowest of those pieces
  std::int32_t tets = 0;
  double ratios = 0;    ///< mean ratios, summed
  double sum = 0;       ///< InverseRatios
  double edge_sum = 0;  ///< one edge at the vertex of each tetrahedron, summed
  double worst = std::numeric_limits<double>::max();
  Vec3 gradient;
  void add(const VertexState& other) {
    tets += other.tets, ratios += other.ratios, sum += other.sum, edge_sum += other.edge_sum;
    first = std::min(first, other.first);
    worst = std::min(worst, other.worst);
    gradient += other.gradient;
  }
};

/// The sum at another place.
struct MovedSum {
  double sum = 0;
  void add(const MovedSum& other) { sum += other.sum; }
};

/// Sums at several places of trial, with the worst quality there.
struct Trials {
  double sum[trial_count] = {};
  double worst[trial_count];

  static constexpr auto fields() { return std::tuple(&Trials::sum, &Trials::worst); }
  Trials() { std::fill_n(worst, trial_count, std::numeric_limits<double>::max()); }
  void add(const Trials& other) {
    for (int i = 0; i < trial_count; ++i) {
      sum[i] += other.sum[i];
      worst[i] = std::min(worst[i], other.worst[i]);
    }
  }
};

/// Whether a tetrahedron does not allow the move.
struct Veto {
  std::uint8_t any = 0;
  void add(const Veto& other) { any |= other.any; }
};

/// The tetrahedra of a piece at the vertices it shares and that may move.
class BorderStars {
public:
  explicit BorderStars(const Piece& piece) {
    std::vector<LocalIndex> slot(piece.vertex_count(), -1);
    for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s) {
      const LocalIndex v = piece.shared_vertices[s];
      if (is_on_boundary(piece.vertex_dimension[v])) continue;
      slot[v] = static_cast<LocalIndex>(_vertices.size());
      _vertices.push_back(v);
      _places.push_back(s);
    }
    _first.assign(_vertices.size() + 1, 0);
    for (const LocalIndex v : piece.cells) {
      if (slot[v] >= 0) ++_first[slot[v] + 1];
    }
    for (std::size_t s = 0; s < _vertices.size(); ++s) _first[s + 1] += _first[s];
    _cells.resize(_first.back());
    std::vector<std::int32_t> next(_first.begin(), _first.end() - 1);
    for (std::size_t i = 0; i < piece.cells.size(); ++i) {
      const LocalIndex s = slot[piece.cells[i]];
      if (s >= 0) _cells[next[s]++] = static_cast<LocalIndex>(i / 4);
    }
  }

  std::size_t size() const { return _vertices.size(); }
  LocalIndex vertex(std::size_t s) const { return _vertices[s]; }
  /// The place of a vertex in the list of shared ones.
  std::size_t place(std::size_t s) const { return _places[s]; }
  std::span<const LocalIndex> cells(std::size_t s) const {
    return {_cells.data() + _first[s], static_cast<std::size_t>(_first[s + 1] - _first[s])};
  }

private:
  std::vector<LocalIndex> _vertices;
  std::vector<std::size_t> _places;
  std::vector<std::int32_t> _first;
  std::vector<LocalIndex> _cells;
};

/// A vertex to be moved, in one piece.
struct Mover {
  std::size_t copy;     ///< in SharedVertices
  std::uint32_t piece;  ///< in mesh.pieces
  std::uint32_t star;   ///< in the piece's BorderStars
  VertexState all;
  double step = 0;  ///< length
  Vec3 to;

  Vec3 direction() const { return 1 / norm(all.gradient) * all.gradient; }
  double wanted() const { return all.sum + MeanRatioSmoothing::least_gain * all.tets; }
};

class BorderSmoothing {
public:
  BorderSmoothing(mesh::DistributedMesh& mesh, const mesh::SharedVertices& shared,
                  const mesh::TetQuality& measure)
      : _mesh(mesh), _shared(shared), _measure(measure) {
    for (const Piece& piece : mesh.pieces) {
      _stars.emplace_back(piece);
      _moved.emplace_back(piece.vertex_count(), -1);
    }
  }

  /// Returns the number of moves counted on this rank.
  std::int64_t move(int group) {
    choose(group);
    find_steps();
    try_steps();
    withdraw();
    std::int64_t count = 0;
    for (const Mover& mover : _movers) {
      Piece& piece = _mesh.pieces[mover.piece];
      piece.set_point(star_vertex(mover), mover.to);
      count += mover.all.first == piece.id;
    }
    return count;
  }

private:
  LocalIndex star_vertex(const Mover& mover) const { return _stars[mover.piece].vertex(mover.star); }
  std::span<const LocalIndex> cells_of(const Mover& mover) const {
    return _stars[mover.piece].cells(mover.star);
  }
  void gather(const Piece& piece, LocalIndex v, std::span<const LocalIndex> cells);
  VertexState measure_state(const Piece& piece, LocalIndex v, std::span<const LocalIndex> cells);
  void choose(int group);
  void find_steps();
  void try_steps();
  void withdraw();
  bool allows(const Piece& piece, const std::vector<std::int32_t>& moved, LocalIndex cell) const;
  double worst_at(const Piece& piece, LocalIndex v, std::span<const LocalIndex> cells, Vec3 p) const;
  /// Adds up the entries of all pieces for each vertex, in the order of pieces, calls keep(mover, sum) for
  /// each mover, and drops the movers for which it is false. `entries` are those of the movers here.
  /// Collective.
  template <class What, class Keep>
  void sum_and_filter(const std::vector<What>& entries, const Keep& keep) {
    std::vector<What> of_copies(_shared.size());
    for (std::size_t m = 0; m < _movers.size(); ++m) of_copies[_movers[m].copy] = entries[m];
    _shared.reduce_and_scatter(of_copies, [](What total, const What& entry) {
      total.add(entry);
      return total;
    });
    std::erase_if(_movers, [&](Mover& mover) { return !keep(mover, of_copies[mover.copy]); });
  }

  mesh::DistributedMesh& _mesh;
  const mesh::SharedVertices& _shared;
  const mesh::TetQuality& _measure;
  std::vector<BorderStars> _stars;
  std::vector<Mover> _movers;
  std::vector<std::vector<std::int32_t>> _moved;  ///< per piece and vertex: its mover, -1 where it stays
  InverseRatios _ratios;
};

void BorderSmoothing::gather(const Piece& piece, LocalIndex v, std::span<const LocalIndex> cells) {
  _ratios.clear();
  for (const LocalIndex t : cells) {
    const LocalIndex* c = piece.cell(t);
    const auto& face = mesh::tetrahedron_faces[std::find(c, c + 4, v) - c];
    _ratios.add(piece.point(c[face[0]]), piece.point(c[face[2]]), piece.point(c[face[1]]));
  }
}

VertexState BorderSmoothing::measure_state(const Piece& piece, LocalIndex v,
                                           std::span<const LocalIndex> cells) {
  VertexState here;
  here.first = piece.id;
  const Vec3 origin = piece.point(v);
  for (const LocalIndex t : cells) {
    const LocalIndex* c = piece.cell(t);
    const auto p = points_of(piece, t);
    here.ratios += mesh::mean_ratio(p[0], p[1], p[2], p[3]);
    here.worst = std::min(here.worst, _measure(p[0], p[1], p[2], p[3]));
    here.edge_sum += distance(origin, c[0] == v ? p[1] : p[0]);
  }
  here.tets = static_cast<std::int32_t>(cells.size());
  gather(piece, v, cells);
  here.sum = _ratios.with_gradient(origin, here.gradient);
  return here;
}

void BorderSmoothing::choose(int group) {
  _movers.clear();
  std::vector<VertexState> entries;
  for (std::uint32_t p = 0; p < _stars.size(); ++p) {
    const Piece& piece = _mesh.pieces[p];
    for (std::uint32_t s = 0; s < _stars[p].size(); ++s) {
      const std::size_t place = _stars[p].place(s);
      if (group_of(piece.shared_keys[place]) != group) continue;
      _movers.push_back({_shared.first(p) + place, p, s, {}, 0, {}});
      entries.push_back(measure_state(piece, _stars[p].vertex(s), _stars[p].cells(s)));
    }
  }
  sum_and_filter(entries, [](Mover& mover, const VertexState& all) {
    mover.all = all;
    return all.tets > 0 && all.ratios < MeanRatioSmoothing::good_enough * all.tets &&
           norm(all.gradient) > 0 && all.sum > InverseRatios::invalid;
  });
}

void BorderSmoothing::find_steps() {
  std::vector<MovedSum> entries;
  for (Mover& mover : _movers) {
    mover.step = MeanRatioSmoothing::first_step * mover.all.edge_sum / mover.all.tets;
    const Piece& piece = _mesh.pieces[mover.piece];
    gather(piece, star_vertex(mover), cells_of(mover));
    entries.push_back({_ratios(piece.point(star_vertex(mover)) + mover.step * mover.direction())});
  }
  sum_and_filter(entries, [](Mover& mover, const MovedSum& there) {
    if (!(there.sum > InverseRatios::invalid)) return true;
    const Peak peak = peak_along(norm(mover.all.gradient), mover.step, there.sum - mover.all.sum);
    mover.step = peak.step;
    return peak.rise >= MeanRatioSmoothing::least_gain * mover.all.tets;
  });
}

double BorderSmoothing::worst_at(const Piece& piece, LocalIndex v, std::span<const LocalIndex> cells,
                                 Vec3 place) const {
  double worst = std::numeric_limits<double>::max();
  for (const LocalIndex t : cells) {
    const LocalIndex* c = piece.cell(t);
    Vec3 p[4];
    for (int k = 0; k < 4; ++k) p[k] = c[k] == v ? place : piece.point(c[k]);
    worst = std::min(worst, _measure(p[0], p[1], p[2], p[3]));
  }
  return worst;
}

void BorderSmoothing::try_steps() {
  std::vector<Trials> entries;
  const auto place = [&](const Mover& mover, int trial) {
    return _mesh.pieces[mover.piece].point(star_vertex(mover)) +
           std::ldexp(mover.step, -trial) * mover.direction();
  };
  for (const Mover& mover : _movers) {
    const Piece& piece = _mesh.pieces[mover.piece];
    gather(piece, star_vertex(mover), cells_of(mover));
    Trials trials;
    for (int i = 0; i < trial_count; ++i) {
      trials.sum[i] = _ratios(place(mover, i));
      trials.worst[i] = trials.sum[i] > InverseRatios::invalid
                            ? worst_at(piece, star_vertex(mover), cells_of(mover), place(mover, i))
                            : -1;
    }
    entries.push_back(trials);
  }
  sum_and_filter(entries, [&](Mover& mover, const Trials& all) {
    for (int i = 0; i < trial_count; ++i) {
      if (all.sum[i] < mover.wanted() || all.worst[i] < mover.all.worst) continue;
      mover.to = place(mover, i);
      return true;
    }
    return false;
  });
}

bool BorderSmoothing::allows(const Piece& piece, const std::vector<std::int32_t>& moved,
                             LocalIndex cell) const {
  const LocalIndex* c = piece.cell(cell);
  double least = std::numeric_limits<double>::max();
  Vec3 p[4];
  for (int k = 0; k < 4; ++k) {
    const std::int32_t m = moved[c[k]];
    p[k] = m < 0 ? piece.point(c[k]) : _movers[m].to;
    if (m >= 0) least = std::min(least, _movers[m].all.worst);
  }
  return _measure(p[0], p[1], p[2], p[3]) >= least && geometry::has_positive_volume(p[0], p[1], p[2], p[3]);
}

// A single move was checked by try_steps(). Where several vertices of a tetrahedron move, either all may or
// none does. This repeats with the remaining ones.
void BorderSmoothing::withdraw() {
  while (true) {
    std::vector<Veto> entries;
    std::int64_t vetoes = 0;
    for (std::size_t m = 0; m < _movers.size(); ++m)
      _moved[_movers[m].piece][star_vertex(_movers[m])] = static_cast<std::int32_t>(m);
    for (const Mover& mover : _movers) {
      const auto cells = cells_of(mover);
      const auto allowed = [&](LocalIndex t) {
        return allows(_mesh.pieces[mover.piece], _moved[mover.piece], t);
      };
      const bool free = std::all_of(cells.begin(), cells.end(), allowed);
      entries.push_back({static_cast<std::uint8_t>(free ? 0 : 1)});
      vetoes += !free;
    }
    for (const Mover& mover : _movers) _moved[mover.piece][star_vertex(mover)] = -1;
    if (_mesh.communicator.sum(vetoes) == 0) return;
    sum_and_filter(entries, [](Mover&, const Veto& veto) { return veto.any == 0; });
  }
}

}  // namespace

std::int64_t smooth_borders(mesh::DistributedMesh& mesh, const mesh::SharedVertices& shared,
                            const mesh::TetQuality& measure, int passes) {
  BorderSmoothing relaxation(mesh, shared, measure);
  std::int64_t moves = 0;
  for (int pass = 0; pass < passes; ++pass) {
    for (int group = 0; group < group_count; ++group) moves += relaxation.move(group);
  }
  return mesh.communicator.sum(moves);
}

}  // namespace aeroloom::improve
