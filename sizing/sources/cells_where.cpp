#include "sizing/sources/cells_where.hpp"

#include <algorithm>

namespace aeroloom::sizing {

using geometry::Vec3;

namespace {

class CellsWhere {
public:
  CellsWhere(const RootCube& root, const RequestInCube& ask, RankOf part, double limit, std::int64_t most)
      : _root(root), _ask(ask), _part(part), _limit(limit), _most(most) {}

  std::vector<SizeSource> find() {
    visit(_root.low, _root.edge, 0, false);
    return std::move(_found);
  }

private:
  /// Subtrees of so many levels go to one rank after the other: what is above them every rank visits.
  static constexpr int levels_of_subtree = 4;

  void visit(Vec3 low, double edge, int level, bool is_mine) {
    if (static_cast<std::int64_t>(_found.size()) > _most) return;
    const double half = 0.5 * edge;
    const Vec3 middle = low + Vec3{half, half, half};
    const CubeRequest asked = _ask(middle, half);
    if (asked.least == no_size) return;
    const int wanted = _root.level(std::min(asked.least, asked.resolution));
    if (!is_mine && level >= wanted - levels_of_subtree) {
      if (_next++ % _part.ranks != _part.rank) return;
      is_mine = true;
    }
    if (level >= wanted) {
      if (asked.size < _limit) _found.push_back({middle, asked.size});
      return;
    }
    for (int child = 0; child < 8; ++child)
      visit(low + half * Vec3{double(child & 1), double(child >> 1 & 1), double(child >> 2)}, half, level + 1,
            is_mine);
  }

  const RootCube& _root;
  const RequestInCube& _ask;
  RankOf _part;
  double _limit;
  std::int64_t _most;
  std::int64_t _next = 0;
  std::vector<SizeSource> _found;
};

}  // namespace

std::vector<SizeSource> sources_where(const RootCube& root, const RequestInCube& ask, RankOf part,
                                      double limit, std::int64_t most) {
  return CellsWhere(root, ask, part, limit, most).find();
}

}  // namespace aeroloom::sizing
