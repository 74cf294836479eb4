#include "cad/model/topology/sheets.hpp"

#include "cad/model/model_data.hpp"
#include "cad/model/topology/sheet_interior.hpp"
#include "cad/tolerances.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace aeroloom::cad {
namespace {

/// Whether a parameter is where the surface ends.
bool is_at_end(const FaceEvaluator& face, Vec2 uv) {
  const auto ends = [](const ParameterRange& range, double parameter) {
    return range.period == 0 && (parameter <= range.low || parameter >= range.high);
  };
  return ends(face.u, uv.x) || ends(face.v, uv.y);
}

}  // namespace

std::int32_t JoinedFace::sheet_at(Vec2 uv) const {
  std::int32_t nearest = 0;
  double least = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    const double off = std::max({sheets[i].low - uv.x, uv.x - sheets[i].high, 0.0});
    if (off < least) least = off, nearest = static_cast<std::int32_t>(i);
  }
  return nearest;
}

Vec2 JoinedFace::from_member(std::int32_t sheet, Vec2 uv) const {
  const Sheet& s = sheets[sheet];
  if (sheets.size() == 1) return uv;
  return {std::clamp(uv.x + s.shift, s.low, s.high), uv.y};
}

const JoinedFace::Use& JoinedFace::use(const Coedge& wanted) const {
  const auto found = std::lower_bound(uses.begin(), uses.end(), wanted, [](const Use& a, const Coedge& b) {
    return std::pair(a.use.edge, a.use.use) < std::pair(b.edge, b.use);
  });
  return *found;
}

std::optional<JoinedFace::Entry> JoinedFace::cross_border(std::int32_t sheet, Vec3 point,
                                                          const std::vector<char>& seen) const {
  std::optional<Entry> entry;
  double least = std::numeric_limits<double>::max();
  for (const SheetBorder& border : borders) {
    if (border.sheets[0] != sheet && border.sheets[1] != sheet) continue;
    const int side = border.sheets[0] == sheet ? 1 : 0;
    if (seen[border.sheets[side]]) continue;
    const double away = distance(border.point, point);
    if (away < least) least = away, entry = Entry{border.sheets[side], border.uv[side]};
  }
  return entry;
}

JoinedModel::Place JoinedModel::locate(FaceId id, Vec2 uv) const {
  const JoinedFace& face = faces.at(id);
  if (face.sheets.size() == 1) return {face.sheets.front().face, 0, uv};
  const std::int32_t sheet = face.sheet_at(uv);
  return {face.sheets[sheet].face, sheet, face.to_member(sheet, uv)};
}

/// Goes from the guess's sheet to the next across the border nearest to the point, until the point's nearest
/// one on a sheet is a foot of a perpendicular inside its loops. A surface that ends where its loops do holds
/// points beyond at its end: those are no feet.
Projection JoinedModel::project(FaceId id, Vec3 point, Vec2 guess) const {
  const JoinedFace& face = faces.at(id);
  const Place start = locate(id, guess);
  Projection found = base.project(start.face, point, start.uv), best = found;
  if (face.sheets.size() == 1) return best;
  const double tolerance = tolerances::foot * base.bounds().diagonal();
  std::int32_t sheet = start.sheet, best_sheet = sheet;
  bool best_inside = false;
  std::vector<char> seen(face.sheets.size(), 0);
  while (true) {
    seen[sheet] = 1;
    const bool inside = found.converged && face.sheets[sheet].interior->contains(found.uv);
    const double away = distance(found.point, point);
    const bool better = best_inside ? inside && away < distance(best.point, point) - tolerance
                                    : inside || (found.converged && !best.converged);
    if (better) best = found, best_sheet = sheet, best_inside = inside;
    const bool held = is_at_end(base.data().face_evaluators[face.sheets[sheet].face], found.uv);
    if (inside && (!held || away <= tolerance)) break;
    const auto entered = face.cross_border(sheet, point, seen);
    if (!entered) break;
    sheet = entered->sheet;
    found = base.project(face.sheets[sheet].face, point, entered->uv);
  }
  best.uv = face.from_member(best_sheet, best.uv);
  return best;
}

Facets JoinedModel::facets(FaceId id, double deflection, double angle, Model::Keep keep) const {
  const JoinedFace& face = faces.at(id);
  if (face.sheets.size() == 1) return base.facets(face.sheets.front().face, deflection, angle, keep);
  Facets all;
  for (std::size_t s = 0; s < face.sheets.size(); ++s) {
    const auto sheet = static_cast<std::int32_t>(s);
    const Facets one = base.facets(face.sheets[s].face, deflection, angle, keep);
    const auto first = static_cast<std::int32_t>(all.points.size());
    all.points.insert(all.points.end(), one.points.begin(), one.points.end());
    for (const Vec2 uv : one.uv) all.uv.push_back(face.from_member(sheet, uv));
    for (const auto& [a, b, c] : one.triangles) all.triangles.push_back({first + a, first + b, first + c});
    for (Facets::BoundaryLine line : one.boundary) {
      const auto use = std::ranges::find_if(face.uses, [&](const JoinedFace::Use& each) {
        return each.sheet == sheet && each.base.edge == line.use.edge && each.base.use == line.use.use;
      });
      line.use = use->use;
      for (std::int32_t& node : line.nodes) node += first;
      all.boundary.push_back(std::move(line));
    }
  }
  return all;
}

}  // namespace aeroloom::cad
