/// Matching of faces and edges over all pieces: what meets at the same vertices is brought together and
/// judged.
///
/// A face or edge whose vertices are not all shared belongs to one piece and is matched there. Only the
/// others, on interfaces, travel: each goes to the rank its global vertex numbers point to.
#pragma once

#include "mesh/data/cell_stars.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "mesh/data/pair_table.hpp"
#include "mesh/exchange/findings.hpp"
#include "mesh/exchange/rendezvous.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace aeroloom::mesh {

/// One of the items that meet at a face or edge.
struct Member {
  PieceId piece;
  std::uint32_t tag;   ///< bit 0: odd, bit 1: role, the rest: item
  std::int32_t label;  ///< what the matcher's `label` says of the item

  bool odd() const { return tag & 1U; }  ///< whether its vertices run against those of even members
  int role() const { return static_cast<int>(tag >> 1) & 1; }
  std::int64_t item() const { return tag >> 2; }
};

/// What the items of role 0 and 1 are called in the report.
using RoleEntities = std::array<Entity, 2>;

/// Sorts the vertices and returns whether that took an odd permutation. Of quadrilaterals: the lowest, that
/// opposite, then its neighbours, ascending; odd where the way round leads to the higher one first.
template <class Index, std::size_t N>
bool sort_vertices(std::array<Index, N>& v) {
  if constexpr (N == 4) {
    std::rotate(v.begin(), std::min_element(v.begin(), v.end()), v.end());
    const bool odd = v[3] < v[1];
    v = {v[0], v[2], std::min(v[1], v[3]), std::max(v[1], v[3])};
    return odd;
  }
  bool odd = false;
  const auto order = [&](std::size_t i, std::size_t j) {
    if (v[j] < v[i]) std::swap(v[i], v[j]), odd = !odd;
  };
  order(0, 1);
  if constexpr (N == 3) order(1, 2), order(0, 1);
  return odd;
}

/// 1 where a vertex of the piece is shared.
inline std::vector<std::uint8_t> mark_shared(const Piece& piece) {
  std::vector<std::uint8_t> marks(piece.vertex_count(), 0);
  for (const LocalIndex v : piece.shared_vertices) marks[v] = 1;
  return marks;
}

/// Whether the faces of the tetrahedra are matched too, as items 4 * cell + face (their sides) of this role.
enum class CellFaces : std::uint8_t { left_out, matched };
inline constexpr int cell_role = 0;

/// What to match: `enumerate(piece, sink)` calls sink(vertices, role, item) for each face or edge, the same
/// in every call; `label(piece, role, item)` is what the judge may know of one of them; `judge(members)` gets
/// all that meet at one and names the rule that is broken, if any.
template <class Enumerate, class Label, class Judge>
struct Matching {
  RoleEntities entities;
  Enumerate enumerate;
  Label label;
  Judge judge;
  CellFaces cell_faces = CellFaces::left_out;
};
template <class Enumerate, class Label, class Judge>
Matching(RoleEntities, Enumerate, Label, Judge) -> Matching<Enumerate, Label, Judge>;
template <class Enumerate, class Label, class Judge>
Matching(RoleEntities, Enumerate, Label, Judge, CellFaces) -> Matching<Enumerate, Label, Judge>;

/// Matches the triangular faces (N = 3), quadrilateral ones (N = 4) or edges (N = 2) of a mesh. Offenders go
/// to `findings`. Collective.
template <std::size_t N, class Enumerate, class Label, class Judge>
class Matcher {
public:
  Matcher(const Matching<Enumerate, Label, Judge>& what, Findings& findings)
      : _what(what), _findings(findings) {}

  void match(const NumberedMesh& mesh) {
    const parallel::Communicator& communicator = mesh.communicator;
    for (std::size_t i = 0; i < mesh.pieces.size(); ++i)
      match_inside(mesh.pieces[i], mesh.numbering.vertices[i]);
    match_across(communicator);
  }

private:
  /// Inside a piece, in the bucket of its lowest vertex.
  struct Inside {
    std::array<LocalIndex, N - 1> rest;
    std::uint32_t tag;
    friend auto operator<=>(const Inside&, const Inside&) = default;
  };
  struct Across {
    std::array<GlobalIndex, N> vertices;
    PieceId piece;
    std::uint32_t tag;
    std::int32_t label;
  };

  static std::uint32_t make_tag(bool odd, int role, std::uint32_t item) {
    return (item << 2) | (static_cast<std::uint32_t>(role) << 1) | (odd ? 1U : 0U);
  }

  void match_inside(const Piece& piece, const std::vector<GlobalIndex>& numbers) {
    const std::vector<std::uint8_t> shared = mark_shared(piece);
    const auto all_shared = [&](const std::array<LocalIndex, N>& v) {
      return std::all_of(v.begin(), v.end(), [&](LocalIndex vertex) { return shared[vertex] != 0; });
    };
    std::vector<std::uint32_t> first(piece.vertex_count() + 2, 0);
    _what.enumerate(piece, [&](const std::array<LocalIndex, N>& v, int, std::uint32_t) {
      if (!all_shared(v)) ++first[*std::min_element(v.begin(), v.end()) + 2];
    });
    for (std::size_t v = 2; v < first.size(); ++v) first[v] += first[v - 1];
    std::vector<Inside> items(first.back());
    _what.enumerate(piece, [&](std::array<LocalIndex, N> v, int role, std::uint32_t item) {
      if (all_shared(v)) return send_across(piece, v, numbers, role, item);
      const bool odd = sort_vertices(v);
      Inside& slot = items[first[v[0] + 1]++];
      std::copy(v.begin() + 1, v.end(), slot.rest.begin());
      slot.tag = make_tag(odd, role, item);
    });
    const auto bucket_of = [&](LocalIndex v) {
      return std::span(items).subspan(first[v], first[v + 1] - first[v]);
    };
    if constexpr (N == 3) {
      if (_what.cell_faces == CellFaces::matched) return match_with_cells(piece, numbers, shared, bucket_of);
    }
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) judge_bucket(piece, v, bucket_of(v), numbers);
  }

  /// Matches the faces of the cells with what is in the buckets: they are put there one vertex at a time.
  template <class BucketOf>
  void match_with_cells(const Piece& piece, const std::vector<GlobalIndex>& numbers,
                        const std::vector<std::uint8_t>& shared, const BucketOf& bucket_of) {
    const CellStars stars(piece, 2);
    std::vector<Inside> bucket;
    for (LocalIndex lowest = 0; lowest < piece.vertex_count(); ++lowest) {
      const auto others = bucket_of(lowest);
      bucket.assign(others.begin(), others.end());
      stars.for_each(lowest, [&](LocalIndex c, const AscendingCell& cell) {
        cell.for_each_face_of(lowest, [&](int left_out, LocalIndex middle, LocalIndex highest) {
          const std::uint32_t item = 4 * static_cast<std::uint32_t>(c) + cell.place(left_out);
          if (shared[lowest] && shared[middle] && shared[highest]) {
            const auto& face = tetrahedron_faces[cell.place(left_out)];
            const LocalIndex* v = piece.cell(c);
            send_across(piece, {v[face[0]], v[face[1]], v[face[2]]}, numbers, cell_role, item);
          } else {
            bucket.push_back({{middle, highest}, make_tag(cell.is_face_odd(left_out), cell_role, item)});
          }
        });
      });
      judge_bucket(piece, lowest, bucket, numbers);
    }
  }

  void send_across(const Piece& piece, const std::array<LocalIndex, N>& v,
                   const std::vector<GlobalIndex>& numbers, int role, std::uint32_t item) {
    std::array<GlobalIndex, N> vertices;
    for (std::size_t k = 0; k < N; ++k) vertices[k] = numbers[v[k]];
    const bool odd = sort_vertices(vertices);
    _across.push_back({vertices, piece.id, make_tag(odd, role, item), _what.label(piece, role, item)});
  }

  /// Whether all that meet in a bucket are fine, and no more than two at a time.
  bool is_bucket_fine(const Piece& piece, std::span<const Inside> bucket) {
    if constexpr (N == 4) return false;  // too long for a key of the table, and few
    const auto member = [&](std::uint32_t tag) {
      Member member{piece.id, tag, 0};
      member.label = _what.label(piece, member.role(), member.item());
      return member;
    };
    const auto is_fine = [&](std::initializer_list<Member> members) {
      return !_what.judge(std::span<const Member>(members.begin(), members.size()));
    };
    _pairs.begin(bucket.size());
    for (const Inside& item : bucket) {
      const PairTable::Outcome met = _pairs.add(key_of(item), item.tag);
      if (met.count > 2) return false;
      if (met.count == 2 && !is_fine({member(met.first), member(item.tag)})) return false;
    }
    return _pairs.all_single([&](std::uint32_t tag) { return is_fine({member(tag)}); });
  }

  static std::uint64_t key_of(const Inside& item) {
    std::uint64_t key = 0;
    for (const LocalIndex v : item.rest) key = key << 32 | static_cast<std::uint32_t>(v);
    return key;
  }

  void judge_bucket(const Piece& piece, LocalIndex lowest, std::span<Inside> bucket,
                    const std::vector<GlobalIndex>& numbers) {
    if (is_bucket_fine(piece, bucket)) return;
    std::sort(bucket.begin(), bucket.end());
    for (std::size_t i = 0, j = 0; i < bucket.size(); i = j) {
      _members.clear();
      for (; j < bucket.size() && bucket[j].rest == bucket[i].rest; ++j) {
        Member& member = _members.emplace_back(Member{piece.id, bucket[j].tag, 0});
        member.label = _what.label(piece, member.role(), member.item());
      }
      const std::optional<Violation> violation = _what.judge(std::span<const Member>(_members));
      if (!violation) continue;
      std::array<GlobalIndex, N> vertices;
      vertices[0] = numbers[lowest];
      for (std::size_t k = 1; k < N; ++k) vertices[k] = numbers[bucket[i].rest[k - 1]];
      report(*violation, vertices);
    }
  }

  void match_across(const parallel::Communicator& communicator) {
    const std::vector<Across> met =
        meet_by_key(communicator, std::exchange(_across, {}), &Across::vertices,
                    [](const Across& item) { return std::tie(item.piece, item.tag, item.label); });
    for_each_key(met, &Across::vertices, [&](std::span<const Across> group) {
      _members.clear();
      for (const Across& item : group) _members.push_back({item.piece, item.tag, item.label});
      if (const std::optional<Violation> violation = _what.judge(std::span<const Member>(_members))) {
        report(*violation, group.front().vertices);
      }
    });
  }

  /// The offender is the member of the lowest piece and item, whatever order they met in.
  void report(Violation violation, std::array<GlobalIndex, N> vertices) {
    std::sort(vertices.begin(), vertices.end());
    Offender offender;
    std::copy(vertices.begin(), vertices.begin() + std::min<std::size_t>(N, 3), offender.key.begin());
    const Member& first =
        *std::min_element(_members.begin(), _members.end(), [](const Member& a, const Member& b) {
          return std::pair(a.piece, a.tag >> 1) < std::pair(b.piece, b.tag >> 1);
        });
    offender.piece = first.piece;
    offender.entity = _what.entities[first.role()];
    offender.item = first.item();
    _findings.add(violation, offender);
  }

  const Matching<Enumerate, Label, Judge>& _what;
  Findings& _findings;
  std::vector<Across> _across;
  std::vector<Member> _members;
  PairTable _pairs;
};

/// Matches and judges all faces (N = 3, 4) or edges (N = 2). See Matcher. Collective.
template <std::size_t N, class Enumerate, class Label, class Judge>
void match_all(const NumberedMesh& mesh, const Matching<Enumerate, Label, Judge>& what, Findings& findings) {
  Matcher<N, Enumerate, Label, Judge>(what, findings).match(mesh);
}

}  // namespace aeroloom::mesh
