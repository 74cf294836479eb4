#include "mesh/checks/enclosures.hpp"

#include "geometry/disjoint_sets.hpp"
#include "mesh/exchange/matching.hpp"
#include "mesh/exchange/rendezvous.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <span>
#include <tuple>
#include <utility>

namespace aeroloom::mesh {
namespace {

using geometry::Box;
using geometry::Vec3;

/// A side of a triangle with a region beside it: twice the triangle, and one for the back.
using SideOfTriangle = std::int32_t;

/// The sides of triangles of a piece that are connected around a region, by the lowest of them.
struct ShellName {
  PieceId piece = 0;
  SideOfTriangle lowest = 0;
  friend auto operator<=>(const ShellName&, const ShellName&) = default;
};

/// A side of a triangle at one of its edges, which runs from the lower global number to the higher one.
struct SideAtEdge {
  std::array<GlobalIndex, 3> key;  ///< vertices of the edge, region
  ShellName name;                  ///< of the side, or of its shell
  Vec3 low, high, opposite;
  bool region_follows;  ///< the region lies behind the triangle, turning around the edge from low to high
};

/// A piece's part of a shell.
struct ShellPart {
  ShellName name;
  RegionId region;
  double volume;  ///< signed
  Box box;
};

struct Meeting {
  ShellName first, second;
  friend auto operator<=>(const Meeting&, const Meeting&) = default;
};

/// The turn around the edge from the first member to this one, from 0 to 2 pi.
double turn_of(const SideAtEdge& side, const SideAtEdge& first) {
  const Vec3 axis = normalized(side.high - side.low);
  const auto across = [&](Vec3 p) {
    const Vec3 arm = p - side.low;
    return arm - dot(arm, axis) * axis;
  };
  const Vec3 zero = across(first.opposite), arm = across(side.opposite);
  const double turn = std::atan2(dot(axis, cross(zero, arm)), dot(zero, arm));
  return turn < 0 ? turn + 2 * std::numbers::pi : turn;
}

/// Calls join(a, b) for sides of one edge and region between which the region lies. Members are in an order
/// that does not depend on ranks.
template <class Join>
void join_around(std::span<const SideAtEdge> members, const Join& join) {
  if (members.size() == 2) return join(members[0], members[1]);
  std::vector<std::pair<double, std::size_t>> turns;
  for (std::size_t i = 0; i < members.size(); ++i)
    turns.emplace_back(i == 0 ? 0 : turn_of(members[i], members[0]), i);
  // Of two in one direction, the region ends at one before it begins at the other.
  std::stable_sort(turns.begin(), turns.end(), [&](const auto& a, const auto& b) {
    return std::pair(a.first, members[a.second].region_follows) <
           std::pair(b.first, members[b.second].region_follows);
  });
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const SideAtEdge& here = members[turns[i].second];
    const SideAtEdge& next = members[turns[(i + 1) % turns.size()].second];
    if (here.region_follows) join(here, next);
  }
}

/// The shells in one piece, and what of them may meet those of others.
class ShellsOfPiece {
public:
  ShellsOfPiece(const DistributedMesh& mesh, const Piece& piece, const std::vector<GlobalIndex>& numbers)
      : _mesh(mesh),
        _piece(piece),
        _numbers(numbers),
        _shared(mark_shared(piece)),
        _sets(2 * static_cast<std::size_t>(piece.cell_count())) {
    join_inside();
  }

  void add_parts(Vec3 origin, std::vector<ShellPart>& parts) {
    std::map<SideOfTriangle, ShellPart> of_shell;
    for_each_side([&](SideOfTriangle side, RegionId region) {
      const SideOfTriangle lowest = _sets.root(side);
      ShellPart& part =
          of_shell.try_emplace(lowest, ShellPart{{_piece.id, lowest}, region, 0, {}}).first->second;
      const LocalIndex* v = _piece.cell(side / 2);
      const Vec3 a = _piece.point(v[0]), b = _piece.point(v[1]), c = _piece.point(v[2]);
      part.volume += (side % 2 == 0 ? 1 : -1) * dot(a - origin, cross(b - origin, c - origin)) / 6;
      for (const Vec3 p : {a, b, c}) part.box.add(p);
    });
    for (const auto& [lowest, part] : of_shell) parts.push_back(part);
  }

  void add_outgoing(std::vector<SideAtEdge>& sides) {
    for (SideAtEdge& side : _outgoing) {
      side.name.lowest = _sets.root(side.name.lowest);
      sides.push_back(side);
    }
  }

private:
  template <class Visit>
  void for_each_side(const Visit& visit) const {
    for (LocalIndex t = 0; t < _piece.cell_count(); ++t) {
      const FaceSides sides = _mesh.sides_of(_piece.triangle_face[t]);
      visit(SideOfTriangle(2 * t), sides.front);
      if (sides.is_inner()) visit(SideOfTriangle(2 * t + 1), sides.back);
    }
  }

  /// Edges between shared vertices may have triangles of other pieces.
  void join_inside() {
    std::vector<SideAtEdge> inside;
    for_each_side([&](SideOfTriangle side, RegionId region) {
      const LocalIndex* v = _piece.cell(side / 2);
      for (int k = 0; k < 3; ++k) {
        LocalIndex low = v[k], high = v[(k + 1) % 3];
        // Seen from outside of `front` triangles are counter-clockwise: it lies before them where they pass
        // the edge forwards.
        const bool forwards = _numbers[low] < _numbers[high], is_back = side % 2 != 0;
        if (!forwards) std::swap(low, high);
        auto& home = _shared[low] && _shared[high] ? _outgoing : inside;
        home.push_back({{_numbers[low], _numbers[high], region},
                        {_piece.id, side},
                        _piece.point(low),
                        _piece.point(high),
                        _piece.point(v[(k + 2) % 3]),
                        forwards == is_back});
      }
    });
    std::sort(inside.begin(), inside.end(), [](const SideAtEdge& a, const SideAtEdge& b) {
      return std::pair(a.key, a.name) < std::pair(b.key, b.name);
    });
    for_each_key(inside, &SideAtEdge::key, [&](std::span<const SideAtEdge> members) {
      join_around(members, [&](const SideAtEdge& a, const SideAtEdge& b) {
        _sets.unite(a.name.lowest, b.name.lowest);
      });
    });
  }

  const DistributedMesh& _mesh;
  const Piece& _piece;
  const std::vector<GlobalIndex>& _numbers;
  std::vector<std::uint8_t> _shared;
  geometry::DisjointSets<SideOfTriangle> _sets;
  std::vector<SideAtEdge> _outgoing;
};

/// The low corner of all pieces, so that volumes do not cancel far from the origin.
Vec3 low_corner(const DistributedMesh& mesh) {
  std::array<double, 3> low;
  low.fill(std::numeric_limits<double>::max());
  for (const Piece& piece : mesh.pieces) {
    for (std::size_t i = 0; i < piece.coordinates.size(); ++i)
      low[i % 3] = std::min(low[i % 3], piece.coordinates[i]);
  }
  mesh.communicator.minimum_each(low);
  return {low[0], low[1], low[2]};
}

/// The pairs of shells of pieces that meet at edges. Collective.
std::vector<Meeting> find_meetings(const DistributedMesh& mesh, std::vector<SideAtEdge> sides) {
  const std::vector<SideAtEdge> received =
      meet_by_key(mesh.communicator, std::move(sides), &SideAtEdge::key, [](const SideAtEdge& side) {
        return std::tuple(side.name, side.opposite.x, side.opposite.y, side.opposite.z);
      });
  std::vector<Meeting> mine;
  for_each_key(received, &SideAtEdge::key, [&](std::span<const SideAtEdge> members) {
    join_around(members, [&](const SideAtEdge& a, const SideAtEdge& b) {
      if (a.name != b.name) mine.push_back({std::min(a.name, b.name), std::max(a.name, b.name)});
    });
  });
  std::sort(mine.begin(), mine.end());
  mine.erase(std::unique(mine.begin(), mine.end()), mine.end());
  return mesh.communicator.all_gather_items<Meeting>(mine);
}

/// Whole shells, from their parts in pieces.
std::vector<ShellPart> assemble(const std::vector<ShellPart>& parts, const std::vector<Meeting>& meetings) {
  const auto index_of = [&](const ShellName& name) {
    const auto found =
        std::lower_bound(parts.begin(), parts.end(), name,
                         [](const ShellPart& part, const ShellName& wanted) { return part.name < wanted; });
    return static_cast<std::int64_t>(found - parts.begin());
  };
  geometry::DisjointSets<std::int64_t> sets(parts.size());
  for (const Meeting& meeting : meetings) sets.unite(index_of(meeting.first), index_of(meeting.second));
  std::map<std::int64_t, ShellPart> shells;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::int64_t root = sets.root(static_cast<std::int64_t>(i));
    const auto [place, is_new] = shells.try_emplace(root, parts[i]);
    if (is_new) continue;
    place->second.volume += parts[i].volume;
    place->second.box.add(parts[i].box);
  }
  std::vector<ShellPart> all;
  all.reserve(shells.size());
  for (const auto& [root, shell] : shells) all.push_back(shell);
  return all;
}

/// The chambers of one region; voids are taken from the smallest whose box holds them.
std::vector<Enclosure> enclosures_of(const std::vector<ShellPart>& shells, RegionId region) {
  std::vector<ShellPart> outer;
  std::vector<double> volumes;
  for (const ShellPart& shell : shells)
    if (shell.region == region && shell.volume > 0) outer.push_back(shell);
  if (outer.size() < 2) return {};
  std::stable_sort(outer.begin(), outer.end(),
                   [](const ShellPart& a, const ShellPart& b) { return a.volume > b.volume; });
  volumes.reserve(outer.size());
  for (const ShellPart& shell : outer) volumes.push_back(shell.volume);
  for (const ShellPart& hole : shells) {
    if (hole.region != region || hole.volume > 0) continue;
    std::size_t around = 0;
    for (std::size_t i = 0; i < outer.size(); ++i)
      if (outer[i].volume > -hole.volume && outer[i].box.contains(hole.box)) around = i;
    volumes[around] += hole.volume;
  }
  std::vector<Enclosure> chambers;
  for (std::size_t i = 0; i < outer.size(); ++i)
    chambers.push_back({region, volumes[i], outer[i].box.center()});
  return chambers;
}

}  // namespace

std::vector<Enclosure> find_enclosures(const NumberedMesh& surface) {
  const Vec3 origin = low_corner(surface);
  std::vector<ShellPart> mine;
  std::vector<SideAtEdge> sides;
  for (std::size_t p = 0; p < surface.pieces.size(); ++p) {
    ShellsOfPiece shells(surface, surface.pieces[p], surface.numbering.vertices[p]);
    shells.add_parts(origin, mine);
    shells.add_outgoing(sides);
  }
  const std::vector<ShellPart> parts = surface.communicator.gather_sorted(mine, &ShellPart::name);
  const std::vector<ShellPart> shells = assemble(parts, find_meetings(surface, std::move(sides)));
  std::vector<Enclosure> all;
  for (RegionId region = 0; region < surface.region_count(); ++region) {
    const std::vector<Enclosure> chambers = enclosures_of(shells, region);
    all.insert(all.end(), chambers.begin(), chambers.end());
  }
  return all;
}

}  // namespace aeroloom::mesh
