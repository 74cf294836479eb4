#include "improve/borders/bad_cells.hpp"

#include "mesh/quality/quality.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aeroloom::improve {

using mesh::LocalIndex;
using mesh::Piece;

BadCells::BadCells(const mesh::DistributedMesh& mesh, const mesh::TetQuality& measure)
    : _measure(measure), _cells(mesh.pieces.size()) {
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) add(mesh.pieces[p], p, 0);
}

void BadCells::add(const Piece& piece, std::size_t p, LocalIndex first) {
  for (LocalIndex t = first; t < piece.cell_count(); ++t) {
    if (quality_of(piece, t, _measure) < _measure.target()) _cells[p].push_back(t);
  }
}

void BadCells::update(const mesh::DistributedMesh& mesh, const cavities::CavityRound& round) {
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const std::vector<LocalIndex>& left = round.changes[p].left;
    auto gone = left.begin();  // removed cells before cell t
    std::erase_if(_cells[p], [&](LocalIndex& t) {
      while (gone != left.end() && *gone < t) ++gone;
      if (gone != left.end() && *gone == t) return true;
      t -= static_cast<LocalIndex>(gone - left.begin());
      return false;
    });
    add(mesh.pieces[p], p, round.changes[p].first_new);
  }
}

BadState BadCells::state(const mesh::DistributedMesh& mesh) const {
  BadState all;
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    all.bad += static_cast<std::int64_t>(_cells[p].size());
    for (const LocalIndex t : _cells[p]) {
      const auto c = points_of(mesh.pieces[p], t);
      all.least_angle = std::min(all.least_angle, mesh::dihedral_range(c[0], c[1], c[2], c[3]).smallest);
    }
  }
  // All other cells have angles within the bounds of the target.
  if (std::sin(all.least_angle * std::numbers::pi / 180) < _measure.target() && all.least_angle < 90)
    return all;
  for (const Piece& piece : mesh.pieces)
    all.least_angle = std::min(all.least_angle, examine(piece, _measure).least_angle);
  return all;
}

}  // namespace aeroloom::improve
