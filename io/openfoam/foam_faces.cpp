#include "io/openfoam/foam_faces.hpp"

#include "parallel/communication/collective_error.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

using mesh::CellNeighbour;
using mesh::FaceLinks;
using mesh::GlobalIndex;
using mesh::LinkDefects;
using mesh::LocalIndex;
using mesh::PieceLinks;

std::size_t side_count(const MeshPart& part, LocalIndex cell) {
  return first_side(*part.piece, cell + 1) - first_side(*part.piece, cell);
}

/// Calls `visit(cell, side, neighbour, number)` for all faces whose other cell has a higher number in the
/// whole mesh, by owner, then other cell; `number` counts them.
template <class Visit>
GlobalIndex for_owned_faces(const MeshPart& part, const PieceLinks& links, const Visit& visit) {
  GlobalIndex number = 0;
  std::vector<std::pair<const CellNeighbour*, std::int32_t>> upper;
  for (LocalIndex cell = 0; cell < part.cell_count(); ++cell) {
    const std::size_t first = first_side(*part.piece, cell), sides = side_count(part, cell);
    upper.clear();
    for (std::size_t side = 0; side < sides; ++side) {
      const CellNeighbour& neighbour = links.neighbours[first + side];
      if (neighbour.exists() && std::tie(neighbour.piece, neighbour.cell) > std::tie(part.id, cell))
        upper.emplace_back(&neighbour, static_cast<std::int32_t>(side));
    }
    std::sort(upper.begin(), upper.end(), [](const auto& a, const auto& b) {
      return std::tie(a.first->piece, a.first->cell, a.second) <
             std::tie(b.first->piece, b.first->cell, b.second);
    });
    for (const auto& [neighbour, side] : upper) visit(cell, side, *neighbour, number++);
  }
  return number;
}

/// The patch of each boundary face of a part, and its place among those of the patch in the part and in the
/// whole mesh (triangles before quadrilaterals).
class PatchPlaces {
public:
  PatchPlaces(const FileMesh& mesh, const MeshPart& part) : _part(part) {
    _triangles.resize(mesh.patches.size(), 0);
    for (const Run& run : part.faces[0].runs) _triangles[run.id] = run.end - run.begin;
    for (std::size_t s = 0; s < face_shape_count; ++s) {
      const std::vector<LocalIndex>& order = part.faces[s].order;
      _place[s].resize(order.size());
      for (std::size_t i = 0; i < order.size(); ++i) _place[s][order[i]] = static_cast<LocalIndex>(i);
    }
    for (const auto& counts : mesh.patch_faces) _all_triangles.push_back(counts[0]);
  }

  struct FoamFacePlace {
    std::int32_t patch = 0;
    LocalIndex in_part = 0;
    GlobalIndex in_mesh = 0;
  };
  /// `face` is a boundary face of the piece.
  FoamFacePlace of(LocalIndex face) const {
    const bool is_triangle = face < _part.faces[0].count();
    const std::size_t s = is_triangle ? 0 : 1;
    const Block& block = _part.faces[s];
    if (!is_triangle) face -= _part.faces[0].count();
    if (!_place[s].empty()) face = _place[s][face];
    const auto run = std::upper_bound(block.runs.begin(), block.runs.end(), face,
                                      [](LocalIndex f, const Run& r) { return f < r.end; });
    const LocalIndex i = face - run->begin;
    if (is_triangle) return {run->id, i, run->before + i};
    return {run->id, i + _triangles[run->id], run->before + i + _all_triangles[run->id]};
  }

private:
  const MeshPart& _part;
  std::array<std::vector<LocalIndex>, face_shape_count> _place;  // in the part, of each face of the piece
  std::vector<LocalIndex> _triangles;
  std::vector<GlobalIndex> _all_triangles;
};

void require_closed(const LinkDefects& defects) {
  if (defects.crowded_faces + defects.stray_faces + defects.repeated_faces + defects.open_faces == 0) return;
  throw parallel::CollectiveError(
      parallel::FailureKind::input,
      fmt::format(
          "OpenFOAM needs each face between two cells or on one patch: {} faces have more than two cells, "
          "{} boundary faces no cell, {} stand twice, {} faces have neither a second cell nor a patch",
          defects.crowded_faces, defects.stray_faces, defects.repeated_faces, defects.open_faces));
}

/// Counts of a part among those of the whole mesh.
struct PartRow {
  GlobalIndex cells, inner_faces;
};

/// By part. Collective.
std::vector<PartRow> gather_part_rows(const FileMesh& mesh, const FaceLinks& links) {
  std::vector<PartRow> mine;
  for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
    const MeshPart& part = mesh.parts[i];
    mine.push_back({part.cell_count(),
                    for_owned_faces(part, links.pieces[i],
                                    [](LocalIndex, std::int32_t, const CellNeighbour&, GlobalIndex) {})});
  }
  return mesh::gather_by_piece(*mesh.pieces, mine);
}

/// Notes of a part to others about the faces between them.
void add_notes(const FileMesh& mesh, const MeshPart& part, const PieceLinks& links,
               std::vector<mesh::Told<FoamFaceNote>>& notes) {
  const PatchPlaces places(mesh, part);
  const auto add = [&](LocalIndex cell, std::size_t side, const CellNeighbour& neighbour,
                       GlobalIndex number) {
    const LocalIndex face = links.boundary_face[first_side(*part.piece, cell) + side];
    notes.push_back({neighbour, {face < 0 ? -1 : places.of(face).patch, number}});
  };
  for_owned_faces(
      part, links,
      [&](LocalIndex cell, std::int32_t side, const CellNeighbour& neighbour, GlobalIndex number) {
        if (neighbour.piece != part.id) add(cell, static_cast<std::size_t>(side), neighbour, number);
      });
  for (LocalIndex cell = 0; cell < part.cell_count(); ++cell) {
    for (std::size_t side = 0; side < side_count(part, cell); ++side) {
      const CellNeighbour& neighbour = links.neighbours[first_side(*part.piece, cell) + side];
      if (neighbour.exists() && neighbour.piece < part.id) add(cell, side, neighbour, -1);
    }
  }
}

/// A face between two parts, and its place in the order of the lower part.
struct ProcessorFace {
  std::int32_t other = 0;
  LocalIndex cell = 0;
  std::int32_t side = 0;
  FoamFace face;
};

/// Puts the faces of one part in order.
class Sorter {
public:
  Sorter(const FileMesh& mesh, const MeshPart& part, const PieceLinks& links, const FoamPlan& plan)
      : _mesh(mesh), _part(part), _links(links), _plan(plan), _places(mesh, part) {}

  FoamFaces sort() {
    add_inner_faces();
    add_patches();
    add_lower_processors();
    add_processors();
    return std::move(_result);
  }

private:
  std::int32_t zone_at(LocalIndex cell, std::size_t side) const {
    const LocalIndex face = _links.boundary_face[first_side(*_part.piece, cell) + side];
    return face < 0 ? -1 : _places.of(face).patch;
  }

  void add_inner_faces() {
    const GlobalIndex first = _plan.first_inner_face[static_cast<std::size_t>(_part.id)];
    for_owned_faces(
        _part, _links,
        [&](LocalIndex cell, std::int32_t side, const CellNeighbour& neighbour, GlobalIndex number) {
          FoamFace face{cell, side, -1, zone_at(cell, static_cast<std::size_t>(side)), first + number, 0, 0};
          if (neighbour.piece == _part.id) {
            face.neighbour = neighbour.cell;
            face.from_front = is_front(face) ? 1 : 0;
            _result.faces.push_back(face);
            return;
          }
          // The boundary face of a zone is in the part of the front region's cell.
          const FoamFaceNote& note = note_at(cell, side);
          face.from_front = face.zone >= 0 ? 1 : 0;
          face.zone = std::max(face.zone, note.zone);
          _processors.push_back({neighbour.piece, cell, side, face});
        });
    _result.inner = static_cast<LocalIndex>(_result.faces.size());
  }

  /// The boundary face goes round like the face of the front region's cell: like that of the owner, or its
  /// reverse.
  bool is_front(const FoamFace& face) const {
    if (face.zone < 0) return false;
    const LocalIndex f =
        _links.boundary_face[first_side(*_part.piece, face.cell) + static_cast<std::size_t>(face.side)];
    const mesh::FaceKey<LocalIndex> corners = mesh::PieceFaces(*_part.piece).face(f);
    const FoamCorners mine = corners_of_face(_part, face);
    const LocalIndex* at = std::find(corners.begin(), corners.end(), mine.corners[0]);
    const LocalIndex next =
        corners[static_cast<std::size_t>(at - corners.begin() + 1) % static_cast<std::size_t>(mine.count)];
    return next == mine.corners[1];
  }

  void add_patches() {
    _result.of_patch.assign(_mesh.patches.size(), 0);
    for (const Block& block : _part.faces) {
      for (const Run& run : block.runs) {
        if (_mesh.patches[run.id].type != mesh::PatchType::interior)
          _result.of_patch[run.id] += run.end - run.begin;
      }
    }
    std::vector<std::size_t> begin(_mesh.patches.size());
    std::size_t next = _result.faces.size();
    for (std::size_t p = 0; p < begin.size(); ++p) {
      begin[p] = next;
      next += static_cast<std::size_t>(_result.of_patch[p]);
    }
    _result.faces.resize(next);
    for (LocalIndex cell = 0; cell < _part.cell_count(); ++cell) {
      const std::size_t first = first_side(*_part.piece, cell);
      for (std::size_t side = 0; side < side_count(_part, cell); ++side) {
        const LocalIndex face = _links.boundary_face[first + side];
        if (face < 0 || _links.neighbours[first + side].exists()) continue;
        const PatchPlaces::FoamFacePlace place = _places.of(face);
        _result.faces[begin[place.patch] + static_cast<std::size_t>(place.in_part)] = {
            cell,
            static_cast<std::int32_t>(side),
            -1,
            -1,
            _plan.first_of_patch[place.patch] + place.in_mesh,
            0,
            0};
      }
    }
  }

  const FoamFaceNote& note_at(LocalIndex cell, std::int32_t side) const {
    const CellNeighbour key{_part.id, cell, side};
    return std::lower_bound(_plan.notes.begin(), _plan.notes.end(), key,
                            [](const auto& note, const CellNeighbour& wanted) { return note.cell < wanted; })
        ->what;
  }

  /// Faces whose owner in the whole mesh is in another part.
  void add_lower_processors() {
    for (LocalIndex cell = 0; cell < _part.cell_count(); ++cell) {
      for (std::size_t side = 0; side < side_count(_part, cell); ++side) {
        const CellNeighbour& neighbour = _links.neighbours[first_side(*_part.piece, cell) + side];
        if (!neighbour.exists() || neighbour.piece >= _part.id) continue;
        const auto s = static_cast<std::int32_t>(side);
        const FoamFaceNote& note = note_at(cell, s);
        const std::int32_t zone = zone_at(cell, side);
        const GlobalIndex number =
            _plan.first_inner_face[static_cast<std::size_t>(neighbour.piece)] + note.number;
        _processors.push_back({neighbour.piece,
                               neighbour.cell,
                               neighbour.side,
                               {cell, s, -1, std::max(zone, note.zone), number, 1,
                                static_cast<std::int8_t>(zone >= 0 ? 1 : 0)}});
      }
    }
  }

  void add_processors() {
    std::sort(_processors.begin(), _processors.end(), [](const ProcessorFace& a, const ProcessorFace& b) {
      return std::tie(a.other, a.cell, a.side) < std::tie(b.other, b.cell, b.side);
    });
    for (const ProcessorFace& face : _processors) {
      if (_result.processors.empty() || _result.processors.back().other != face.other)
        _result.processors.push_back({face.other, 0});
      ++_result.processors.back().count;
      _result.faces.push_back(face.face);
    }
  }

  const FileMesh& _mesh;
  const MeshPart& _part;
  const PieceLinks& _links;
  const FoamPlan& _plan;
  PatchPlaces _places;
  FoamFaces _result;
  std::vector<ProcessorFace> _processors;
};

}  // namespace

FoamCorners corners_of_face(const MeshPart& part, const FoamFace& face) {
  const mesh::CellOfPiece cell = cell_of(*part.piece, face.cell);
  const LocalIndex* v = vertices_of(*part.piece, cell);
  FoamCorners result;
  for (const std::int8_t corner : faces_of(cell.shape)[static_cast<std::size_t>(face.side)]) {
    if (corner >= 0) result.corners[static_cast<std::size_t>(result.count++)] = v[corner];
  }
  const auto begin = result.corners.begin(), end = begin + result.count;
  std::rotate(begin,
              std::min_element(begin, end,
                               [&](LocalIndex a, LocalIndex b) { return part.numbers[a] < part.numbers[b]; }),
              end);
  return result;
}

FoamPlan plan_faces(const FileMesh& mesh, const FaceLinks& links) {
  require_closed(links.defects);
  FoamPlan plan;
  for (const PartRow& row : gather_part_rows(mesh, links)) {
    plan.first_cell.push_back(plan.cells);
    plan.first_inner_face.push_back(plan.faces);
    plan.cells += row.cells;
    plan.faces += row.inner_faces;
  }
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    plan.first_of_patch.push_back(plan.faces);
    if (mesh.patches[p].type != mesh::PatchType::interior)
      plan.faces += mesh.patch_faces[p][0] + mesh.patch_faces[p][1];
  }
  std::vector<mesh::Told<FoamFaceNote>> notes;
  for (std::size_t i = 0; i < mesh.parts.size(); ++i) add_notes(mesh, mesh.parts[i], links.pieces[i], notes);
  plan.notes = mesh::tell_cells(*mesh.pieces, std::move(notes));
  return plan;
}

FoamFaces order_faces(const FileMesh& mesh, const MeshPart& part, const PieceLinks& links,
                      const FoamPlan& plan) {
  return Sorter(mesh, part, links, plan).sort();
}

}  // namespace aeroloom::io
