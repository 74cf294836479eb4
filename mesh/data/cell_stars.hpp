/// The tetrahedra of a piece around its vertices, for what looks at each face or edge once.
#pragma once

#include "mesh/data/piece.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::mesh {

/// The vertices of a tetrahedron, ascending.
class AscendingCell {
public:
  explicit AscendingCell(const LocalIndex* cell) {
    for (std::uint32_t k = 0; k < 4; ++k) _keys[k] = static_cast<std::uint32_t>(cell[k]) << 2 | k;
    order(0, 1), order(2, 3), order(0, 2), order(1, 3), order(1, 2);
  }
  LocalIndex operator[](int k) const { return static_cast<LocalIndex>(_keys[k] >> 2); }
  /// Its place in the tetrahedron.
  int place(int k) const { return static_cast<int>(_keys[k] & 3); }
  /// Whether the face that leaves out vertex k, counter-clockwise seen from outside, takes an odd permutation
  /// to ascend.
  bool is_face_odd(int k) const { return odd_permutation() != ((k & 1) != 0); }
  /// Calls visit(left_out, middle, highest) for the faces of which the first or second vertex of the cell is
  /// the lowest: what they leave out, and their other vertices.
  template <class Visit>
  void for_each_face_of(LocalIndex lowest, const Visit& visit) const {
    if ((*this)[0] == lowest) {
      visit(1, (*this)[2], (*this)[3]);
      visit(2, (*this)[1], (*this)[3]);
      visit(3, (*this)[1], (*this)[2]);
    } else {
      visit(0, (*this)[2], (*this)[3]);
    }
  }

private:
  void order(int i, int j) {
    const std::uint32_t both = _keys[i] ^ _keys[j], low = std::min(_keys[i], _keys[j]);
    _keys[i] = low, _keys[j] = both ^ low;  // without a branch
  }
  bool odd_permutation() const {
    const std::uint32_t a = _keys[0] & 3, b = _keys[1] & 3, c = _keys[2] & 3, d = _keys[3] & 3;
    return ((a > b) ^ (a > c) ^ (a > d) ^ (b > c) ^ (b > d) ^ (c > d)) != 0;
  }

  std::array<std::uint32_t, 4> _keys;  ///< vertex and place
};

/// The tetrahedra of a piece by vertex: each is found at the `lowest` lowest of its vertices. Refers to the
/// piece.
class CellStars {
public:
  CellStars(const Piece& piece, int lowest) : _piece(piece), _first(piece.vertex_count() + 2, 0) {
    const auto for_each_use = [&](const auto& use) {
      for (LocalIndex c = 0; c < piece.cell_count(); ++c) {
        const AscendingCell cell(piece.cell(c));
        for (int k = 0; k < lowest; ++k) use(cell[k], c);
      }
    };
    for_each_use([&](LocalIndex v, LocalIndex) { ++_first[v + 2]; });
    for (std::size_t v = 2; v < _first.size(); ++v) _first[v] += _first[v - 1];
    _cells.resize(_first.back() + look_ahead);
    for_each_use([&](LocalIndex v, LocalIndex c) { _cells[_first[v + 1]++] = c; });
  }

  /// Calls visit(cell, ascending) for those found at a vertex, ascending.
  template <class Visit>
  void for_each(LocalIndex v, const Visit& visit) const {
    for (std::uint32_t i = _first[v]; i < _first[v + 1]; ++i) {
      __builtin_prefetch(_piece.cell(_cells[i + look_ahead]));
      visit(_cells[i], AscendingCell(_piece.cell(_cells[i])));
    }
  }

private:
  static constexpr int look_ahead = 32;

  const Piece& _piece;
  std::vector<std::uint32_t> _first;
  std::vector<LocalIndex> _cells;
};

/// Calls visit(a, b), a < b, once for each edge of a tetrahedral piece, ascending; of those only whose first
/// vertex is a multiple of `stride`.
template <class Visit>
void for_each_edge(const Piece& piece, const Visit& visit, LocalIndex stride = 1) {
  const CellStars stars(piece, 3);
  std::vector<LocalIndex> seen_from(piece.vertex_count(), -1), ends;
  for (LocalIndex a = 0; a < piece.vertex_count(); a += stride) {
    ends.clear();
    stars.for_each(a, [&](LocalIndex, const AscendingCell& cell) {
      for (int k = 3; cell[k] != a; --k) {
        const LocalIndex b = cell[k];
        if (seen_from[b] != a) ends.push_back(b);
        seen_from[b] = a;
      }
    });
    std::sort(ends.begin(), ends.end());
    for (const LocalIndex b : ends) visit(a, b);
  }
}

}  // namespace aeroloom::mesh
