#include "cad/model/sheets.hpp"

#include "cad/model/model_data.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <BRepTopAdaptor_FClass2d.hxx>
#include <gp_Pnt2d.hxx>

namespace aeroloom::cad {
namespace {

bool lies_inside(const Sheet& sheet, Vec2 uv) {
  return sheet.inside->Perform(gp_Pnt2d(uv.x, uv.y)) != TopAbs_OUT;
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

const JoinedFace::Use& JoinedFace::use(const EdgeUse& wanted) const {
  const auto found = std::lower_bound(uses.begin(), uses.end(), wanted, [](const Use& a, const EdgeUse& b) {
    return std::pair(a.use.edge, a.use.use) < std::pair(b.edge, b.use);
  });
  return *found;
}

JoinedFaces::Place JoinedFaces::locate(FaceId id, Vec2 uv) const {
  const JoinedFace& face = faces.at(id);
  if (face.sheets.size() == 1) return {face.sheets.front().face, 0, uv};
  const std::int32_t sheet = face.sheet_at(uv);
  return {face.sheets[sheet].face, sheet, face.to_member(sheet, uv)};
}

/// The nearest point of the guess's sheet; where that lies beyond the sheet's loops, the point of the sheet
/// on the other side of the nearest border.
Projection JoinedFaces::project(FaceId id, Vec3 point, Vec2 guess) const {
  const JoinedFace& face = faces.at(id);
  const Place start = locate(id, guess);
  Projection found = base.project(start.face, point, start.uv);
  if (face.sheets.size() == 1) return found;
  std::int32_t sheet = start.sheet;
  if (!found.converged || !lies_inside(face.sheets[sheet], found.uv)) {
    const SheetBorder* nearest = nullptr;
    double least = std::numeric_limits<double>::max();
    for (const SheetBorder& border : face.borders) {
      if (border.sheets[0] != sheet && border.sheets[1] != sheet) continue;
      const double away = distance(border.point, point);
      if (away < least) least = away, nearest = &border;
    }
    if (nearest != nullptr) {
      const int side = nearest->sheets[0] == sheet ? 1 : 0;
      const std::int32_t other = nearest->sheets[side];
      const Projection beyond = base.project(face.sheets[other].face, point, nearest->uv[side]);
      if (beyond.converged && (!found.converged || lies_inside(face.sheets[other], beyond.uv))) {
        found = beyond;
        sheet = other;
      }
    }
  }
  found.uv = face.from_member(sheet, found.uv);
  return found;
}

Facets JoinedFaces::facets(FaceId id, double deflection, double angle, Model::Keep keep) const {
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
      const auto use = std::find_if(face.uses.begin(), face.uses.end(), [&](const JoinedFace::Use& each) {
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
