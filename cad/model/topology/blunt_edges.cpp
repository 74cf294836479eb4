#include "cad/model/topology/blunt_edges.hpp"

#include "cad/model/evaluation/face_corners.hpp"
#include "cad/model/evaluation/face_width.hpp"
#include "cad/model/topology/border_path.hpp"
#include "cad/tolerances.hpp"
#include "geometry/angle.hpp"

#include <algorithm>
#include <limits>
#include <ranges>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

using geometry::degree;
/// Strips are this many times longer than wide, at least: a face that is less slender is a wall of its own.
/// Chosen, not measured.
constexpr double slenderness = 10;
/// An edge across a strip's end is at most this fraction of the long borders: else the face is a triangle or
/// a fan. Chosen, not measured.
constexpr double end_fraction = 0.25;
/// Places inside a strip where angles and widths are measured: a wing's sections change slowly along it.
constexpr int stations = 9;

using Kind = BluntEdgeFinding::Kind;

struct Run {
  std::vector<Coedge> uses;
  double length = 0;
};

/// The direction of the loop at the start or end of a coedge, as a chord over a small fraction of the edge.
Vec3 direction_at(const Model& model, const Coedge& use, bool at_start) {
  const Edge& edge = model.edge(use.edge);
  const double range = edge.last_parameter - edge.first_parameter;
  const bool at_last = use.reversed == at_start;
  const double end = at_last ? edge.last_parameter : edge.first_parameter;
  const Vec3 inner =
      model.edge_point(use.edge, end + (at_last ? -tolerances::beside_end : tolerances::beside_end) * range);
  const Vec3 outer = model.edge_point(use.edge, end);
  return normalized(at_start ? inner - outer : outer - inner);
}

/// The loop cut at its corners; nothing where it has none.
std::vector<Run> cut_at_corners(const Model& model, const std::vector<Coedge>& loop) {
  const std::size_t count = loop.size();
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < count; ++i) {
    const Coedge& before = loop[(i + count - 1) % count];
    if (angle_between(direction_at(model, before, false), direction_at(model, loop[i], true)) >
        tolerances::smooth)
      starts.push_back(i);
  }
  std::vector<Run> runs;
  for (std::size_t k = 0; k < starts.size(); ++k) {
    Run run;
    const std::size_t end = k + 1 < starts.size() ? starts[k + 1] : starts.front() + count;
    for (std::size_t i = starts[k]; i < end; ++i) {
      run.uses.push_back(loop[i % count]);
      run.length += rough_length(model, loop[i % count].edge);
    }
    runs.push_back(std::move(run));
  }
  return runs;
}

/// Two long runs and what lies between them: behind the first, behind the second.
struct Sides {
  std::array<Run, 2> borders;
  std::array<Run, 2> ends;
};

/// Tells borders from ends; `runs` are two to four.
Sides tell_sides(std::vector<Run> runs) {
  const auto rotate = [&](std::size_t first) {
    std::rotate(runs.begin(), runs.begin() + static_cast<std::ptrdiff_t>(first), runs.end());
  };
  if (runs.size() == 4) {
    if (runs[1].length + runs[3].length > runs[0].length + runs[2].length) rotate(1);
    return {{runs[0], runs[2]}, {runs[1], runs[3]}};
  }
  if (runs.size() == 3) {
    const auto shortest =
        std::ranges::min_element(runs, [](const Run& a, const Run& b) { return a.length < b.length; });
    rotate(static_cast<std::size_t>(shortest - runs.begin()));
    return {{runs[2], runs[1]}, {runs[0], {}}};
  }
  return {{runs[0], runs[1]}, {}};
}

/// The two borders of a strip from the same end of the strip to the other: the second against the loop.
std::string lay_borders(const Model& model, const Sides& sides, BluntEdge& strip) {
  for (int side = 0; side < 2; ++side) {
    for (const Coedge& use : sides.borders[side].uses) {
      const FaceId neighbour = neighbour_face(model, strip.face, use.edge);
      if (neighbour == no_entity) return "a long border is not shared with one other face";
      strip.borders[side].push_back({use, use.reversed != (side == 1), neighbour});
    }
  }
  std::reverse(strip.borders[1].begin(), strip.borders[1].end());
  // Behind the first border the strip ends, behind the second it starts.
  for (int end = 0; end < 2; ++end) {
    for (const Coedge& use : sides.ends[1 - end].uses) {
      if (neighbour_face(model, strip.face, use.edge) == no_entity)
        return "an edge at an end is not shared with one other face";
      strip.ends[end].push_back(use.edge);
    }
  }
  return {};
}

/// How the strip and its neighbours stand at one place.
struct Section {
  double turns[2] = {0, 0};  ///< of the normal across the borders
  bool convex = false;       ///< both neighbours lie behind the strip, seen from the fluid
  double opening = 0;        ///< angle between the neighbours
  Vec3 along, into;          ///< of a station
};

Section section_at(const Model& model, const BluntEdge& strip,
                   const std::array<BorderPath::ChainPlace, 2>& at) {
  Section section;
  Vec3 into[2];
  section.convex = true;
  for (int side = 0; side < 2; ++side) {
    const BorderEdge& border = strip.borders[side][at[side].edge];
    const Coedge use = coedge_along(model, border.neighbour, border.strip_use.edge);
    const double t = at[side].parameter;
    const Vec3 own = model.face_frame(strip.face, model.edge_uv(strip.face, border.strip_use, t)).normal;
    const Vec3 normal = model.face_frame(border.neighbour, model.edge_uv(border.neighbour, use, t)).normal;
    const Vec3 along = (use.reversed ? -1.0 : 1.0) * normalized(model.edge_tangent(use.edge, t));
    into[side] = cross(normal, along);  // material is on the loop's left
    section.turns[side] = angle_between(own, normal);
    // The normal points out of the fluid, into the body that the neighbours enclose.
    section.convex = section.convex && dot(into[side], own) > 0;
  }
  section.opening = angle_between(into[0], into[1]);
  const BorderEdge& border = strip.borders[0][at[0].edge];
  section.along = normalized(model.edge_tangent(border.strip_use.edge, at[0].parameter));
  section.into = normalized(into[0] + into[1]);
  return section;
}

/// How far the neighbours along a border extend from it, about.
double breadth(const Model& model, const std::vector<BorderEdge>& border, double length) {
  std::set<FaceId> faces;
  double area = 0;
  for (const BorderEdge& each : border) {
    if (faces.insert(each.neighbour).second) area += model.face_area(each.neighbour);
  }
  return area / length;
}

std::string unfit_neighbours(const Model& model, const BluntEdge& strip) {
  const Face& own = model.face(strip.face);
  for (int side = 0; side < 2; ++side) {
    for (const BorderEdge& each : strip.borders[side]) {
      const Face& face = model.face(each.neighbour);
      if (model.is_far_field(each.neighbour)) return "it borders on the far field";
      if (face.front != own.front || face.back != no_entity)
        return fmt::format("its neighbour '{}' lies between other regions", face.name);
      for (const BorderEdge& other : strip.borders[1]) {
        if (side == 0 && other.neighbour == each.neighbour)
          return fmt::format("both long borders belong to the same face '{}'", face.name);
      }
    }
  }
  return {};
}

/// Measures the strip and judges its shape.
void judge(const Model& model, double width, BluntEdgeFinding& finding) {
  BluntEdge& strip = finding.edge;
  const BorderPath first(model, strip.borders[0]), second(model, strip.borders[1]);
  strip.length = std::max(first.length(), second.length());
  double widest_turn[2] = {0, 0}, widest_opening = 0;
  bool convex = true;
  strip.narrowest = std::numeric_limits<double>::max();
  std::vector<BluntStation> along;
  for (int i = 0; i <= stations + 1; ++i) {
    const double fraction = static_cast<double>(i) / (stations + 1);
    std::array<BorderPath::ChainPlace, 2> at{first.at(fraction * first.length()), {}};
    at[1] = second.nearest(at[0].point);
    double width = distance(at[0].point, at[1].point);
    // Where a strip ends obliquely one border goes on without the other.
    if (i == 0 || i == stations + 1) {
      const Vec3 end = second.at(fraction * second.length()).point;
      width = std::min(width, distance(end, first.nearest(end).point));
    }
    strip.widest = std::max(strip.widest, width);
    const bool is_point = (i == 0 && strip.ends[0].empty()) || (i > stations && strip.ends[1].empty());
    if (!is_point) strip.narrowest = std::min(strip.narrowest, width);
    along.push_back({0.5 * (at[0].point + at[1].point), {}, {}, width});
    if (i == (stations + 1) / 2) strip.place = 0.5 * (at[0].point + at[1].point);
    if (i == 0 || i == stations + 1) continue;
    const Section section = section_at(model, strip, at);
    along.back().along = section.along, along.back().into = section.into;
    for (int side = 0; side < 2; ++side) widest_turn[side] = std::max(widest_turn[side], section.turns[side]);
    widest_opening = std::max(widest_opening, section.opening);
    convex = convex && section.convex;
  }
  // At the ends, where neighbours may end obliquely, directions are those near by.
  for (const auto& [end, next] : {std::pair(0, 1), std::pair(stations + 1, stations)})
    along[end].along = along[next].along, along[end].into = along[next].into;
  strip.stations = std::move(along);
  if (strip.widest * slenderness > 2 * strip.length) return;  // narrow on average only
  const auto refuse = [&](Kind kind, std::string reason) {
    finding.kind = kind, finding.reason = std::move(reason);
  };
  for (int side = 0; side < 2; ++side) {
    if (widest_turn[side] < tolerances::smooth) {
      const FaceId into = strip.borders[side].front().neighbour;
      return refuse(Kind::smooth, fmt::format("it goes on smoothly in '{}'", model.face(into).name));
    }
  }
  if (!convex)
    return refuse(Kind::refused, "its neighbours do not enclose the body behind it: a step or a slot");
  if (widest_opening > 90 * degree) {
    return refuse(Kind::refused, fmt::format("its neighbours meet at {:.0f} degrees, which is no sharp edge",
                                             widest_opening / degree));
  }
  double& limit = finding.limit;
  limit = width;
  if (!(limit > 0)) {
    const double narrower = std::min(breadth(model, strip.borders[0], first.length()),
                                     breadth(model, strip.borders[1], second.length()));
    limit = std::min(blunt_edge_length_fraction * strip.length, blunt_edge_breadth_fraction * narrower);
  }
  if (strip.widest > limit) {
    return refuse(Kind::wide, fmt::format("it is {:.3g} wide, more than {:.3g}; geometry.sharpen_width sets "
                                          "what is closed",
                                          strip.widest, limit));
  }
  finding.kind = Kind::closable;
}

}  // namespace

BluntEdgeFinding examine_blunt_edge(const Model& model, FaceId id, double width) {
  BluntEdgeFinding finding;
  BluntEdge& strip = finding.edge;
  strip.face = id;
  const Face& face = model.face(id);
  if (model.is_far_field(id) || model.is_faceted(id)) return finding;
  double perimeter = 0;
  for (const Coedge& use : face.loops | std::views::join) perimeter += rough_length(model, use.edge);
  const double mean = mean_width(model, id);
  if (!(mean * slenderness < 0.5 * perimeter)) return finding;
  const auto refuse = [&](std::string reason) {
    finding.kind = Kind::refused, finding.reason = std::move(reason);
    return finding;
  };
  strip.place = model.edge_point(face.loops.front().front().edge,
                                 model.edge(face.loops.front().front().edge).first_parameter);
  strip.length = 0.5 * perimeter, strip.widest = mean;
  if (face.back != no_entity) return refuse("it lies between two regions");
  if (face.loops.size() > 1) return refuse("it is a closed ring");
  std::vector<Coedge> loop;
  for (const Coedge& use : face.loops.front()) {
    if (model.is_seam(use.edge)) return refuse("it is a closed ring");
    if (!model.edge(use.edge).degenerate) loop.push_back(use);
  }
  const std::vector<Run> runs = cut_at_corners(model, loop);
  if (runs.size() < 2 || runs.size() > 4)
    return refuse(fmt::format("it has {} corners, not those of a strip", runs.size()));
  const Sides sides = tell_sides(runs);
  const double border = std::min(sides.borders[0].length, sides.borders[1].length);
  if (std::max(sides.ends[0].length, sides.ends[1].length) > end_fraction * border)
    return refuse("it is not bounded by two long borders");
  for (std::string reason : {lay_borders(model, sides, strip), unfit_neighbours(model, strip)}) {
    if (!reason.empty()) return refuse(std::move(reason));
  }
  judge(model, width, finding);
  return finding;
}

}  // namespace aeroloom::cad
