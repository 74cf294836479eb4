/// Faces of the cells of one part by their vertices. Internal to io/.
#pragma once

#include "io/face_links.hpp"
#include "io/file_mesh.hpp"
#include "mesh/mixing.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace aeroloom::io {

/// The corners of a face, ascending; a triangle's last is -1.
template <class Index>
using FaceKey = std::array<Index, 4>;

template <class Index>
FaceKey<Index> face_key(FaceKey<Index> corners) {
  const auto order = [&](std::size_t i, std::size_t j) {
    if (corners[j] < corners[i]) std::swap(corners[i], corners[j]);
  };
  order(0, 1), order(1, 2), order(0, 1);
  if (corners[3] >= 0) order(2, 3), order(1, 2), order(0, 1);
  return corners;
}

/// The rank on which all that have a face meet.
inline parallel::Rank meeting_rank(const FaceKey<mesh::GlobalIndex>& key, int ranks) {
  std::uint64_t mixed = 0;
  for (const mesh::GlobalIndex v : key) mixed = mesh::mix_in(mixed, static_cast<std::uint64_t>(v));
  return mesh::meeting_rank(mixed, ranks);
}

/// The corners of a cell's face as vertices, counter-clockwise from outside; a triangle's last is -1.
template <class Index>
FaceKey<Index> corners_at(const CellFace& face, const Index* cell) {
  FaceKey<Index> corners{};
  for (std::size_t k = 0; k < 4; ++k) corners[k] = face[k] < 0 ? Index{-1} : cell[face[k]];
  return corners;
}

/// Whether two ways round the same corners are the same, or the same the other way round. Corners of a
/// quadrilateral may be in an order that is neither.
template <class Index>
bool same_direction(const FaceKey<Index>& a, const FaceKey<Index>& b) {
  const std::size_t corners = a[3] < 0 ? 3 : 4;
  std::size_t at = 0;
  while (at < corners && b[at] != a[0]) ++at;
  return b[(at + 1) % corners] == a[1] && b[(at + 2) % corners] == a[2];
}
template <class Index>
bool opposite_direction(FaceKey<Index> a, const FaceKey<Index>& b) {
  std::swap(a[1], a[a[3] < 0 ? 2 : 3]);
  return same_direction(a, b);
}

/// One that has the face: a side of a cell (cell and side), or a boundary face (side -1 and its number).
struct FaceUser {
  mesh::LocalIndex item = -1;
  std::int32_t side = -1;
  bool is_cell() const { return side >= 0; }
};

/// Sorts items, equal ones in their order; few of them without making room.
template <class Iterator, class Less>
void sort_in_turn(Iterator begin, Iterator end, const Less& less) {
  constexpr std::ptrdiff_t few = 48;
  if (end - begin > few) return std::stable_sort(begin, end, less);
  for (Iterator i = begin; i != end; ++i) {
    for (Iterator j = i; j != begin && less(*j, *(j - 1)); --j) std::swap(*j, *(j - 1));
  }
}

/// Calls `visit(key, users)` once for each set of equal faces among `cells` and boundary faces, in the order
/// of lowest vertices. `CellSource` has for_each_side(sink(corners, cell, side)) and for_each_face(
/// sink(corners, face)), the same in every call; vertices run from 0 to `vertices` - 1.
template <class Source, class Visit>
void match_faces(std::size_t vertices, const Source& source, const Visit& visit) {
  struct Entry {
    std::array<mesh::LocalIndex, 3> rest;
    FaceUser user;
  };
  std::vector<std::size_t> first(vertices + 2, 0);
  const auto lowest = [](const FaceKey<mesh::LocalIndex>& c) {
    return std::min({c[0], c[1], c[2], c[3] < 0 ? c[0] : c[3]});
  };
  source.for_each_side(
      [&](const FaceKey<mesh::LocalIndex>& c, mesh::LocalIndex, std::int32_t) { ++first[lowest(c) + 2]; });
  source.for_each_face([&](const FaceKey<mesh::LocalIndex>& c, mesh::LocalIndex) { ++first[lowest(c) + 2]; });
  for (std::size_t v = 2; v < first.size(); ++v) first[v] += first[v - 1];
  std::vector<Entry> entries(first.back());
  const auto put = [&](const FaceKey<mesh::LocalIndex>& corners, FaceUser user) {
    const auto key = face_key(corners);
    entries[first[key[0] + 1]++] = {{key[1], key[2], key[3]}, user};
  };
  source.for_each_side([&](const FaceKey<mesh::LocalIndex>& c, mesh::LocalIndex cell, std::int32_t side) {
    put(c, {cell, side});
  });
  source.for_each_face([&](const FaceKey<mesh::LocalIndex>& c, mesh::LocalIndex face) {
    put(c, {face, -1});
  });
  std::vector<FaceUser> users;
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto begin = entries.begin() + static_cast<std::ptrdiff_t>(first[v]);
    const auto end = entries.begin() + static_cast<std::ptrdiff_t>(first[v + 1]);
    sort_in_turn(begin, end, [](const Entry& a, const Entry& b) { return a.rest < b.rest; });
    for (auto i = begin; i != end;) {
      users.clear();
      const auto& rest = i->rest;
      auto j = i;
      for (; j != end && j->rest == rest; ++j) users.push_back(j->user);
      visit(FaceKey<mesh::LocalIndex>{static_cast<mesh::LocalIndex>(v), rest[0], rest[1], rest[2]},
            std::span<const FaceUser>(users));
      i = j;
    }
  }
}

/// The cells and boundary faces of a part, for match_faces; cells by number of face_links.hpp.
class PartFaces {
public:
  explicit PartFaces(const FilePart& part) : _part(part) {}

  template <class Sink>
  void for_each_side(const Sink& sink) const {
    mesh::LocalIndex cell = 0;
    for (const CellShape shape : cell_shapes) {
      const Block& block = _part.cells[static_cast<std::size_t>(shape)];
      const auto faces = faces_of(shape);
      for (mesh::LocalIndex i = 0; i < block.count(); ++i, ++cell) {
        for (std::size_t side = 0; side < faces.size(); ++side)
          sink(corners_at(faces[side], block.item(i)), cell, static_cast<std::int32_t>(side));
      }
    }
  }

  template <class Sink>
  void for_each_face(const Sink& sink) const {
    mesh::LocalIndex face = 0;
    for (const Block& block : _part.faces) {
      for (mesh::LocalIndex i = 0; i < block.count(); ++i, ++face) {
        const mesh::LocalIndex* v = block.item(i);
        sink(FaceKey<mesh::LocalIndex>{v[0], v[1], v[2], block.corners == 4 ? v[3] : -1}, face);
      }
    }
  }

  FaceKey<mesh::LocalIndex> side(mesh::LocalIndex cell, std::int32_t side) const {
    const CellOfPart place = cell_of(_part, cell);
    return corners_at(faces_of(place.shape)[static_cast<std::size_t>(side)],
                      _part.cells[static_cast<std::size_t>(place.shape)].item(place.index));
  }
  FaceKey<mesh::LocalIndex> face(mesh::LocalIndex face) const {
    const bool triangle = face < _part.faces[0].count();
    const mesh::LocalIndex* v =
        triangle ? _part.faces[0].item(face) : _part.faces[1].item(face - _part.faces[0].count());
    return {v[0], v[1], v[2], triangle ? -1 : v[3]};
  }

private:
  const FilePart& _part;
};

}  // namespace aeroloom::io
