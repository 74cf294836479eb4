#include "io/face_links.hpp"

#include "io/part_faces.hpp"
#include "mesh/delivery.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace aeroloom::io {

namespace {

using mesh::GlobalIndex;
using mesh::LocalIndex;

/// A side of a cell that found no other cell in its part.
struct LoneSide {
  FaceKey<GlobalIndex> key;
  std::int32_t part;
  LocalIndex cell;
  std::int32_t side;
  std::int32_t rank;     ///< where the part lives
  std::int32_t bounded;  ///< 1: there is a boundary face

  static constexpr auto fields() {
    return std::tuple(&LoneSide::key, &LoneSide::part, &LoneSide::cell, &LoneSide::side, &LoneSide::rank,
                      &LoneSide::bounded);
  }
};

/// Tells a part what lies behind a side.
struct Introduction {
  std::int32_t part;
  LocalIndex cell;
  std::int32_t side;
  CellBehind behind;
  std::int32_t rank;

  static constexpr auto fields() {
    return std::tuple(&Introduction::part, &Introduction::cell, &Introduction::side, &Introduction::behind,
                      &Introduction::rank);
  }
};

/// Matches what is inside one part.
class PartLinker {
public:
  PartLinker(const FilePart& part, parallel::Rank rank, std::vector<LoneSide>& lone, LinkDefects& defects)
      : _part(part), _rank(rank), _lone(lone), _defects(defects) {}

  PartLinks link() {
    const std::size_t sides = first_side(_part, _part.cell_count());
    _links.behind.resize(sides);
    _links.boundary_face.assign(sides, -1);
    match_faces(static_cast<std::size_t>(_part.vertex_count()), PartFaces(_part),
                [&](const FaceKey<LocalIndex>& key, std::span<const FaceUser> users) { settle(key, users); });
    return std::move(_links);
  }

private:
  void settle(const FaceKey<LocalIndex>& key, std::span<const FaceUser> users) {
    LocalIndex face = -1;
    std::array<FaceUser, 2> cells;
    std::size_t count = 0;
    for (const FaceUser& user : users) {
      if (!user.is_cell()) {
        if (face >= 0) ++_defects.repeated_faces;
        face = user.item;
      } else {
        if (count < 2) cells[count] = user;
        ++count;
      }
    }
    if (count == 0) ++_defects.stray_faces;
    if (count > 2) ++_defects.crowded_faces;
    if (count == 0 || count > 2) return;
    for (std::size_t i = 0; i < count; ++i) _links.boundary_face[side_of(cells[i])] = face;
    if (count == 2) {
      _links.behind[side_of(cells[0])] = {_part.id, cells[1].item, cells[1].side};
      _links.behind[side_of(cells[1])] = {_part.id, cells[0].item, cells[0].side};
      return;
    }
    FaceKey<GlobalIndex> numbers{-1, -1, -1, -1};
    for (std::size_t k = 0; k < 4; ++k) {
      if (key[k] >= 0) numbers[k] = _part.numbers[key[k]];
    }
    _lone.push_back({face_key(numbers), _part.id, cells[0].item, cells[0].side, _rank, face >= 0 ? 1 : 0});
  }

  std::size_t side_of(const FaceUser& user) const {
    return first_side(_part, user.item) + static_cast<std::size_t>(user.side);
  }

  const FilePart& _part;
  parallel::Rank _rank;
  std::vector<LoneSide>& _lone;
  LinkDefects& _defects;
  PartLinks _links;
};

std::vector<Introduction> introduce(const parallel::Communicator& communicator, std::vector<LoneSide> lone,
                                    LinkDefects& defects) {
  std::vector<LoneSide> met = mesh::deliver(communicator, std::move(lone), [&](const LoneSide& side) {
    return meeting_rank(side.key, communicator.size());
  });
  std::sort(met.begin(), met.end(), [](const LoneSide& a, const LoneSide& b) {
    return std::tie(a.key, a.part, a.cell) < std::tie(b.key, b.part, b.cell);
  });
  std::vector<Introduction> introductions;
  for (std::size_t i = 0, j = 0; i < met.size(); i = j) {
    for (j = i; j < met.size() && met[j].key == met[i].key;) ++j;
    if (j - i > 2) ++defects.crowded_faces;
    if (j - i == 1 && met[i].bounded == 0) ++defects.open_faces;
    if (j - i != 2) continue;
    for (const auto& [to, from] : {std::pair(&met[i], &met[i + 1]), std::pair(&met[i + 1], &met[i])}) {
      introductions.push_back({to->part, to->cell, to->side, {from->part, from->cell, from->side}, to->rank});
    }
  }
  return mesh::deliver(communicator, std::move(introductions),
                       [](const Introduction& item) { return static_cast<parallel::Rank>(item.rank); });
}

}  // namespace

CellOfPart cell_of(const FilePart& part, LocalIndex cell) {
  std::size_t shape = 0;
  while (shape + 1 < cell_shape_count && cell >= part.cells[shape].count())
    cell -= part.cells[shape++].count();
  return {cell_shapes[shape], cell};
}

std::size_t first_side(const FilePart& part, LocalIndex cell) {
  const auto tetrahedra = static_cast<std::size_t>(std::min(cell, part.cells[0].count()));
  return 5 * static_cast<std::size_t>(cell) - tetrahedra;
}

FaceLinks link_faces(const parallel::Communicator& communicator, const FileMesh& mesh) {
  FaceLinks links;
  std::vector<LoneSide> lone;
  for (const FilePart& part : mesh.parts)
    links.parts.push_back(PartLinker(part, communicator.rank(), lone, links.defects).link());
  for (const Introduction& item : introduce(communicator, std::move(lone), links.defects)) {
    const auto found = std::lower_bound(mesh.parts.begin(), mesh.parts.end(), item.part,
                                        [](const FilePart& part, std::int32_t id) { return part.id < id; });
    PartLinks& part = links.parts[static_cast<std::size_t>(found - mesh.parts.begin())];
    part.behind[first_side(*found, item.cell) + static_cast<std::size_t>(item.side)] = item.behind;
  }
  LinkDefects& defects = links.defects;
  for (GlobalIndex* count :
       {&defects.crowded_faces, &defects.stray_faces, &defects.repeated_faces, &defects.open_faces})
    *count = communicator.sum(*count);
  return links;
}

}  // namespace aeroloom::io
