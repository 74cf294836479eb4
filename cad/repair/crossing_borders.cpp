#include "cad/repair/crossing_borders.hpp"

#include "cad/model/evaluation/point_locator.hpp"
#include "cad/model/library_unit.hpp"
#include "geometry/box_tree.hpp"
#include "geometry/shown_list.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

// Chosen, not measured: a crossing is clear where the curves part on both sides by more than what CAD
// programs leave between curves that meet. The distance is one of the border's extent.
constexpr int parts_per_span = 4, most_halvings = 8;
constexpr std::size_t most_chords = 20000;  // of a face
constexpr double clear_distance = 2e-5;

/// A chord of an edge in the parameter plane.
struct BorderChord {
  std::size_t use;  // among the coedges of the face
  double from, to;  // parameters
  Vec2 begin, end;
};

/// Twice the signed area of a triangle.
double turn_of(Vec2 a, Vec2 b, Vec2 c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Places on a chord count as left of it, so that no crossing falls between two chords.
bool on_both_sides(const BorderChord& chord, const BorderChord& other) {
  return (turn_of(chord.begin, chord.end, other.begin) >= 0) !=
         (turn_of(chord.begin, chord.end, other.end) >= 0);
}
bool chords_cross(const BorderChord& a, const BorderChord& b) {
  return on_both_sides(a, b) && on_both_sides(b, a);
}

/// Of the first, as if both were straight.
double parameter_of_crossing(const BorderChord& chord, const BorderChord& other) {
  const double before = turn_of(other.begin, other.end, chord.begin),
               after = turn_of(other.begin, other.end, chord.end);
  const double fraction = before == after ? 0.5 : before / (before - after);
  return chord.from + fraction * (chord.to - chord.from);
}

class BorderOfFace {
public:
  BorderOfFace(const Model& model, FaceId face) : _model(model), _face(face) {
    for (const auto& loop : model.face(face).loops) {
      for (const Coedge& use : loop) {
        if (!model.edge(use.edge).degenerate && !model.is_seam(use.edge)) _uses.push_back(use);
      }
    }
    for (const Coedge& use : _uses) {
      const Edge& ends = model.edge(use.edge);
      constexpr int places = 16;
      for (int i = 0; i <= places; ++i)
        _box.add(model.edge_point(
            use.edge, ends.first_parameter + (ends.last_parameter - ends.first_parameter) * i / places));
    }
    for (std::size_t u = 0; u < _uses.size(); ++u) {
      const std::vector<double> breaks = model.edge_breaks(_uses[u].edge);
      for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
        for (int part = 0; part < parts_per_span; ++part) {
          const double step = (breaks[i + 1] - breaks[i]) / parts_per_span;
          add_fine_chords(u, breaks[i] + part * step,
                          part + 1 == parts_per_span ? breaks[i + 1] : breaks[i] + (part + 1) * step,
                          most_halvings);
        }
      }
    }
  }

  std::optional<BorderCrossing> find() const {
    std::vector<geometry::Box> boxes;
    for (const BorderChord& chord : _chords) {
      geometry::Box& box = boxes.emplace_back();
      box.add(Vec3{chord.begin.x, chord.begin.y, 0}), box.add(Vec3{chord.end.x, chord.end.y, 0});
    }
    const geometry::BoxTree tree(boxes, 8);
    std::optional<BorderCrossing> found;
    for (std::size_t i = 0; i < _chords.size() && !found; ++i) {
      geometry::for_each_overlap(tree, boxes, boxes[i], [&](std::int32_t other) {
        const auto j = static_cast<std::size_t>(other);
        if (found || j <= i || !chords_cross(_chords[i], _chords[j])) return;
        found = confirm(_chords[i], _chords[j]);
      });
    }
    return found;
  }

private:
  /// Chords that lie nearer to the edge than what counts as clear.
  void add_fine_chords(std::size_t use, double from, double to, int halvings) {
    const EdgeId edge = _uses[use].edge;
    const Vec3 begin = _model.edge_point(edge, from), end = _model.edge_point(edge, to);
    double off = 0;
    for (const double part : {0.25, 0.5, 0.75}) {
      const Vec3 on_chord = begin + part * (end - begin);
      off = std::max(off, distance(on_chord, _model.edge_point(edge, from + part * (to - from))));
    }
    if (off > 0.5 * clear_distance * _box.diagonal() && halvings > 0 && _chords.size() < most_chords) {
      const double middle = 0.5 * (from + to);
      add_fine_chords(use, from, middle, halvings - 1);
      add_fine_chords(use, middle, to, halvings - 1);
      return;
    }
    add_chords(use, from, to, 1, _chords);
  }

  void add_chords(std::size_t use, double from, double to, int count,
                  std::vector<BorderChord>& chords) const {
    Vec2 begin = _model.edge_uv(_face, _uses[use], from);
    double at = from;
    for (int i = 1; i <= count; ++i) {
      const double next = i == count ? to : from + (to - from) * i / count;
      const Vec2 end = _model.edge_uv(_face, _uses[use], next);
      chords.push_back({use, at, next, begin, end});
      begin = end, at = next;
    }
  }

  /// Cuts both chords anew, a few times. What crosses no more was none.
  std::optional<BorderCrossing> confirm(BorderChord a, BorderChord b) const {
    constexpr int rounds = 4, parts = 8;
    for (int round = 0; round < rounds; ++round) {
      std::vector<BorderChord> first, second;
      add_chords(a.use, a.from, a.to, parts, first), add_chords(b.use, b.from, b.to, parts, second);
      bool any = false;
      for (std::size_t i = 0; i < first.size() && !any; ++i) {
        for (std::size_t j = 0; j < second.size() && !any; ++j) {
          if (!chords_cross(first[i], second[j])) continue;
          a = first[i], b = second[j];
          any = true;
        }
      }
      if (!any) return std::nullopt;
    }
    return in_space(a, b);
  }

  std::optional<BorderCrossing> in_space(const BorderChord& a, const BorderChord& b) const {
    const EdgeId first = _uses[a.use].edge, second = _uses[b.use].edge;
    const double s = parameter_of_crossing(a, b), t = parameter_of_crossing(b, a);
    const double clear = std::max(clear_distance * _box.diagonal(), 2 * _model.sewn_gap());
    const Vec3 at = _model.edge_point(first, s);
    if (distance(at, _model.edge_point(second, t)) > clear) return std::nullopt;
    if (!part_on_both_sides(first, s, second, clear) || !part_on_both_sides(second, t, first, clear))
      return std::nullopt;
    return BorderCrossing{_face, first, second, at};
  }

  /// Whether an edge gets farther than that from another, before and after a parameter.
  bool part_on_both_sides(EdgeId edge, double parameter, EdgeId other, double clear) const {
    const Edge& ends = _model.edge(edge);
    return gets_clear(edge, parameter, ends.first_parameter, other, clear) &&
           gets_clear(edge, parameter, ends.last_parameter, other, clear);
  }

  bool gets_clear(EdgeId edge, double from, double to, EdgeId other, double clear) const {
    constexpr int steps = 16;
    for (int i = 1; i <= steps; ++i) {
      const Vec3 at = _model.edge_point(edge, from + (to - from) * i / steps);
      if (nearest_sampled(other, at) > clear && foot_on_edge_near(other, at) > clear) return true;
    }
    return false;
  }

  /// The nearest place of an edge among its samples; `best` is its parameter.
  double nearest_sampled(EdgeId edge, Vec3 at, double* best = nullptr) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& [parameter, place] : samples_of(edge)) {
      const double apart = distance(at, place);
      if (apart >= nearest) continue;
      nearest = apart;
      if (best != nullptr) *best = parameter;
    }
    return nearest;
  }

  struct EdgeSample {
    double parameter;
    Vec3 place;
  };

  /// Made once: places of splines in no order cost a hundred times what comparing them does.
  const std::vector<EdgeSample>& samples_of(EdgeId edge) const {
    constexpr int count = 48;
    std::vector<EdgeSample>& samples = _samples[edge];
    if (!samples.empty()) return samples;
    const Edge& ends = _model.edge(edge);
    for (int i = 0; i <= count; ++i) {
      const double t = ends.first_parameter + (ends.last_parameter - ends.first_parameter) * i / count;
      samples.push_back({t, _model.edge_point(edge, t)});
    }
    return samples;
  }

  double foot_on_edge_near(EdgeId edge, Vec3 at) const {
    double guess = 0;
    nearest_sampled(edge, at, &guess);
    return distance(at, _model.edge_point(edge, project_on_edge(_model, edge, at, guess)));
  }

  const Model& _model;
  FaceId _face;
  std::vector<Coedge> _uses;
  std::vector<BorderChord> _chords;
  mutable std::map<EdgeId, std::vector<EdgeSample>> _samples;
  Box _box;
};

}  // namespace

std::vector<BorderCrossing> find_border_crossings(const Model& model) {
  std::vector<BorderCrossing> crossings;
  for (FaceId f = 0; f < model.face_count(); ++f) {
    if (model.is_faceted(f) || model.sheet_count(f) > 1) continue;
    if (const std::optional<BorderCrossing> found = BorderOfFace(model, f).find())
      crossings.push_back(*found);
  }
  return crossings;
}

void refuse_border_crossings(const Model& model) {
  const std::vector<BorderCrossing> crossings = find_border_crossings(model);
  if (crossings.empty()) return;
  const std::string text = geometry::shown_list(crossings, [&](const BorderCrossing& crossing) {
    const Face& face = model.face(crossing.face);
    return fmt::format("face '{}' (patch '{}') near {}", face.name,
                       model.patches()[static_cast<std::size_t>(face.patch)], place_in_file(crossing.place));
  });
  throw CadError(
      fmt::format("the border of a face crosses itself, so that it has no inside there: {}. Remedy: draw the "
                  "curves anew in the CAD program so that they meet at their ends only",
                  text));
}

}  // namespace aeroloom::cad
