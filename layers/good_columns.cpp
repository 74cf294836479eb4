#include "layers/good_columns.hpp"

#include "geometry/sort_unique.hpp"
#include "layers/column_source.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace aeroloom::layers {
namespace {

/// The layered triangles around vertices, each once.
std::vector<std::int32_t> triangles_at(const LocalWall& wall, const std::vector<std::int32_t>& vertices,
                                       std::vector<std::uint8_t>& seen) {
  std::vector<std::int32_t> triangles;
  for (const std::int32_t v : vertices) {
    for (const std::int32_t t : wall.triangles_around(v)) {
      if (wall.roles[t] != WallRole::layered || seen[t] != 0) continue;
      seen[t] = 1;
      triangles.push_back(t);
    }
  }
  for (const std::int32_t t : triangles) seen[t] = 0;
  return triangles;
}

/// The faces of fans at vertices, each once.
std::vector<std::int32_t> faces_at(const Fans& fans, const std::vector<std::int32_t>& vertices) {
  std::vector<std::int32_t> faces;
  for (const std::int32_t v : vertices) {
    const auto around = fans.faces_around(v);
    faces.insert(faces.end(), around.begin(), around.end());
  }
  geometry::sort_unique(faces);
  return faces;
}

/// What was judged before, or what is judged now for later.
class Verdicts {
public:
  Verdicts(const ColumnSource& source, JudgedColumns* judged) : _source(source), _judged(judged) {
    if (judged == nullptr) return;
    _is_known = !judged->heights.empty();
    if (_is_known) return;
    judged->corners = source.fans.columns;
    judged->directions = source.directions.smoothed;
    for (std::int32_t v = 0; v < source.wall.vertex_count(); ++v)
      judged->heights.push_back(source.limits.regular_heights(v));
    judged->last_states.assign(source.wall.points.size(), -1);
    judged->last_verdicts.assign(source.wall.triangles.size(), -1);
  }

  void begin_round(std::int32_t round, const std::vector<std::int32_t>& changed) {
    _round = round;
    if (!is_noted()) return;
    for (const std::int32_t v : changed) {
      std::int32_t& last = _judged->last_states[v];
      _judged->states.push_back({_source.limits.fitted(v), round, last});
      last = static_cast<std::int32_t>(_judged->states.size()) - 1;
    }
  }

  double fitting_height_over(std::int32_t t) {
    if (_judged != nullptr && _is_known) {
      if (const JudgedColumns::Verdict* known = find(t)) return known->height;
    }
    const double height = fitting_height(_source.over(t));
    if (is_noted()) {
      std::int32_t& last = _judged->last_verdicts[t];
      _judged->verdicts.push_back({height, _round, last});
      last = static_cast<std::int32_t>(_judged->verdicts.size()) - 1;
    }
    return height;
  }

private:
  bool is_noted() const { return _judged != nullptr && !_is_known; }

  /// Of the same round, if the columns were the same then; else nullptr.
  const JudgedColumns::Verdict* find(std::int32_t t) const {
    std::int32_t at = _judged->last_verdicts[t];
    while (at >= 0 && _judged->verdicts[at].round > _round) at = _judged->verdicts[at].before;
    if (at < 0 || _judged->verdicts[at].round != _round) return nullptr;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!was_same(t, i)) return nullptr;
    }
    return &_judged->verdicts[at];
  }

  bool was_same(std::int32_t t, std::size_t corner) const {
    const std::int32_t v = _source.wall.triangles[t][corner];
    std::int32_t at = _judged->last_states[v];
    while (at >= 0 && _judged->states[at].since > _round) at = _judged->states[at].before;
    return at >= 0 && _judged->states[at].fitted == _source.limits.fitted(v) &&
           _judged->heights[v] == _source.limits.regular_heights(v) &&
           _judged->directions[_judged->corners[t][corner]] ==
               _source.directions.smoothed[_source.fans.columns[t][corner]];
  }

  const ColumnSource& _source;
  JudgedColumns* _judged;
  bool _is_known = false;
  std::int32_t _round = 0;
};

}  // namespace

int shrink_to_good(const LocalWall& wall, const Fans& fans, const Directions& directions,
                   ColumnLimits& limits, JudgedColumns* judged) {
  const ColumnSource source{wall, fans, directions, limits};
  Verdicts verdicts(source, judged);
  std::vector<std::uint8_t> seen(wall.triangles.size(), 0);
  for (int rounds = 0;; ++rounds) {
    std::vector<double> totals(wall.points.size(), std::numeric_limits<double>::infinity());
    std::int64_t bad = 0;
    const auto bound = [&](std::int32_t v, double height) {
      if (limits.total(v) > height) totals[v] = std::min(totals[v], height);
    };
    const std::vector<std::int32_t> changed = limits.take_changed();
    verdicts.begin_round(rounds, changed);
    for (const std::int32_t t : triangles_at(wall, changed, seen)) {
      const double height = verdicts.fitting_height_over(t);
      if (height == std::numeric_limits<double>::infinity()) continue;
      ++bad;
      for (const std::int32_t v : wall.triangles[t]) bound(v, height);
    }
    for (const std::int32_t f : faces_at(fans, changed)) {
      const FanFace& face = fans.faces[f];
      const double height = fitting_height(source.over(face));
      if (height == std::numeric_limits<double>::infinity()) continue;
      ++bad;
      for (const int end : {0, 2}) bound(fans.vertex_of(face.columns[end]), height);
    }
    if (wall.mesh.communicator.sum(bad) == 0) return rounds;
    limits.limit_totals(std::move(totals), LayerLimit::validity);
    limits.converge();
  }
}

}  // namespace aeroloom::layers
