#include "pipeline/surface_rims.hpp"

#include "mesh/delivery.hpp"

#include <algorithm>

namespace aeroloom::pipeline {
namespace {

using geometry::Vec3;
using mesh::LocalIndex;
using mesh::Piece;

/// The middle of a cell.
struct Middle {
  Vec3 weighted;  // sum of centres times areas
  double area = 0;
  double nearest = 1e300;  // distance of a vertex to it
};

/// A surface piece as cells are grown on it.
class Patch {
public:
  explicit Patch(const Piece& piece) : _points(piece.vertex_count()), _triangles(piece.cell_count()) {
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) _points[v] = piece.point(v);
    for (LocalIndex t = 0; t < piece.cell_count(); ++t)
      _triangles[t] = {piece.cell(t)[0], piece.cell(t)[1], piece.cell(t)[2]};
  }
  partition::FinePatch view() const { return {_points, _triangles}; }

private:
  std::vector<Vec3> _points;
  std::vector<std::array<std::int32_t, 3>> _triangles;
};

/// Per vertex the one cell around it, -1 on rims: where several cells meet or the piece ends.
std::vector<std::int32_t> cell_of_vertices(const Piece& piece, const std::vector<std::int32_t>& cell) {
  constexpr std::int32_t unseen = -2, rim = -1;
  std::vector<std::int32_t> of_vertex(piece.vertex_count(), unseen);
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    for (int k = 0; k < 3; ++k) {
      std::int32_t& mine = of_vertex[piece.cell(t)[k]];
      mine = mine == unseen || mine == cell[t] ? cell[t] : rim;
    }
  }
  for (const LocalIndex v : piece.shared_vertices) of_vertex[v] = rim;
  return of_vertex;
}

/// One surface piece and its cells.
struct PieceCells {
  const Piece& piece;
  const std::vector<mesh::GlobalIndex>& number;  // per vertex
  const std::vector<std::int32_t>& local;        // cell per triangle, numbered within the piece
  const std::vector<std::int32_t>& global;       // the same over all pieces
  std::vector<std::int32_t> of_vertex;           // the one cell around a vertex, -1 on rims
};

/// The sides that have no other triangle of the same cell across, with their vertices.
void add_rim(const PieceCells& cells, std::vector<partition::RimEdge>& edges,
             std::vector<partition::FineVertex>& vertices) {
  struct Side {
    LocalIndex low, high, from, to;
    std::int32_t cell;
  };
  const Piece& piece = cells.piece;
  std::vector<Side> sides;
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const LocalIndex from = piece.cell(t)[k], to = piece.cell(t)[(k + 1) % 3];
      if (cells.of_vertex[from] >= 0 || cells.of_vertex[to] >= 0) continue;
      sides.push_back({std::min(from, to), std::max(from, to), from, to, cells.global[t]});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& s, const Side& t) {
    return s.low != t.low ? s.low < t.low : s.high != t.high ? s.high < t.high : s.cell < t.cell;
  });
  std::vector<char> sent(piece.vertex_count(), 0);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Side& side = sides[i];
    if (i + 1 < sides.size() && sides[i + 1].low == side.low && sides[i + 1].high == side.high &&
        sides[i + 1].cell == side.cell) {
      ++i;
      continue;
    }
    edges.push_back({cells.number[side.from], cells.number[side.to], side.cell});
    for (const LocalIndex v : {side.from, side.to}) {
      if (sent[v]) continue;
      sent[v] = 1;
      vertices.push_back(
          {cells.number[v], piece.point(v), piece.vertex_dimension[v], piece.vertex_entity[v]});
    }
  }
}

/// The cells of a piece: their areas, and the vertices nearest to their middles.
void add_cells(const PieceCells& cells, std::int32_t count, std::vector<partition::Cell>& result) {
  const Piece& piece = cells.piece;
  std::vector<partition::Cell> mine(count, {-1, piece.common_face(), -1, {}, {}});
  std::vector<Middle> middles(count);
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    const LocalIndex* v = piece.cell(t);
    const std::int32_t c = cells.local[t];
    const Vec3 a = piece.point(v[0]), b = piece.point(v[1]), d = piece.point(v[2]);
    const Vec3 area = 0.5 * cross(b - a, d - a);
    mine[c].id = cells.global[t];
    mine[c].area += area;
    middles[c].weighted += norm(area) * ((a + b + d) / 3.0);
    middles[c].area += norm(area);
  }
  for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
    const std::int32_t c = cells.of_vertex[v];
    if (c < 0) continue;
    const double away = distance(piece.point(v), middles[c].weighted / middles[c].area);
    if (away >= middles[c].nearest) continue;
    middles[c].nearest = away;
    mine[c].apex = cells.number[v];
    mine[c].apex_point = piece.point(v);
  }
  result.insert(result.end(), mine.begin(), mine.end());
}

}  // namespace

SurfaceCells::SurfaceCells(const parallel::Communicator& communicator, const mesh::DistributedMesh& surface,
                           const mesh::Numbering& numbering, const partition::CellOptions& options)
    : _communicator(communicator), _surface(surface), _numbering(numbering) {
  for (const Piece& piece : surface.pieces) {
    const Patch patch(piece);
    _local.push_back(partition::grow_cells(patch.view(), options));
  }
  number();
}

void SurfaceCells::cut(const std::vector<std::int32_t>& cells) {
  for (std::size_t p = 0; p < _cell.size(); ++p) {
    std::vector<char> mine(_count[p], 0);
    for (std::size_t t = 0; t < _cell[p].size(); ++t) {
      if (std::binary_search(cells.begin(), cells.end(), _cell[p][t])) mine[_local[p][t]] = 1;
    }
    if (std::find(mine.begin(), mine.end(), 1) == mine.end()) continue;
    const Patch patch(_surface.pieces[p]);
    _local[p] = partition::cut_cells(patch.view(), std::move(_local[p]), mine);
  }
  number();
}

void SurfaceCells::number() {
  _count.clear();
  for (const auto& cells : _local)
    _count.push_back(cells.empty() ? 0 : 1 + *std::max_element(cells.begin(), cells.end()));
  const std::vector<std::int32_t> counts = mesh::gather_by_piece(_communicator, _surface, _count);
  std::vector<std::int32_t> first(counts.size() + 1, 0);
  for (std::size_t p = 0; p < counts.size(); ++p) first[p + 1] = first[p] + counts[p];
  _cell = _local;
  for (std::size_t p = 0; p < _cell.size(); ++p) {
    for (std::int32_t& c : _cell[p]) c += first[_surface.pieces[p].id];
  }
}

SurfaceCells::Rims SurfaceCells::gather() const {
  Rims mine;
  for (std::size_t p = 0; p < _cell.size(); ++p) {
    const PieceCells cells{_surface.pieces[p], _numbering.vertices[p], _local[p], _cell[p],
                           cell_of_vertices(_surface.pieces[p], _local[p])};
    add_rim(cells, mine.edges, mine.vertices);
    add_cells(cells, _count[p], mine.cells);
  }
  Rims rims;
  rims.edges = _communicator.gather_items<partition::RimEdge>(mine.edges);
  rims.vertices = _communicator.gather_items<partition::FineVertex>(mine.vertices);
  rims.cells = _communicator.gather_items<partition::Cell>(mine.cells);
  std::sort(rims.cells.begin(), rims.cells.end(),
            [](const partition::Cell& a, const partition::Cell& b) { return a.id < b.id; });
  return rims;
}

}  // namespace aeroloom::pipeline
