#include "sizing/lifting/lifting_section.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace aeroloom::sizing {
namespace {

using geometry::Vec2;
using geometry::Vec3;

/// A point where a plane meets an edge of a facet.
struct CutPoint {
  Vec3 point;
  Vec2 uv;
  cad::FaceId face;
};

/// A facet's part of a section.
struct CutFacet {
  std::array<CutPoint, 2> ends;
  double first, last;  ///< ahead, first <= last
};

std::vector<CutFacet> cut_skin(const std::vector<ModelFacet>& skin, const CuttingPlane& plane) {
  std::vector<CutFacet> cuts;
  for (const ModelFacet& facet : skin) {
    const Triangle& t = facet.corners;
    std::array<double, 3> away;
    for (int i = 0; i < 3; ++i) away[i] = dot(t[i] - plane.origin, plane.normal);
    CutFacet cut;
    int found = 0;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      if ((away[i] >= 0) == (away[j] >= 0)) continue;
      const double fraction = away[i] / (away[i] - away[j]);
      cut.ends[found++] = {t[i] + fraction * (t[j] - t[i]),
                           facet.parameters[i] + fraction * (facet.parameters[j] - facet.parameters[i]),
                           facet.face};
    }
    if (found < 2) continue;
    const double a = dot(cut.ends[0].point - plane.origin, plane.ahead),
                 b = dot(cut.ends[1].point - plane.origin, plane.ahead);
    cut.first = std::min(a, b), cut.last = std::max(a, b);
    cuts.push_back(cut);
  }
  return cuts;
}

/// What hangs together with the cut nearest to a place. Facets of two faces may leave a gap between them.
std::vector<CutFacet> connected(std::vector<CutFacet> cuts, Vec3 origin, double gap) {
  constexpr double gap_fraction = 0.005;  // of what the cuts extend over; chosen, not measured
  double farthest = 0;
  const auto nearer = [&](const CutFacet& a, const CutFacet& b) {
    const auto away = [&](const CutFacet& cut) {
      return std::min(distance(cut.ends[0].point, origin), distance(cut.ends[1].point, origin));
    };
    return away(a) < away(b);
  };
  for (const CutFacet& cut : cuts) farthest = std::max(farthest, distance(cut.ends[0].point, origin));
  const double near = std::max(gap, gap_fraction * farthest);
  const auto touch = [&](const CutFacet& a, const CutFacet& b) {
    for (const CutPoint& p : a.ends) {
      for (const CutPoint& q : b.ends)
        if (distance(p.point, q.point) <= near) return true;
    }
    return false;
  };
  const auto first = std::min_element(cuts.begin(), cuts.end(), nearer);
  if (first == cuts.end()) return {};
  std::iter_swap(cuts.begin(), first);
  std::size_t count = 1;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = count; j < cuts.size(); ++j)
      if (touch(cuts[i], cuts[j])) std::swap(cuts[j], cuts[count++]);
  }
  cuts.resize(count);
  return cuts;
}

/// Climbs on the CAD surface, within the plane, to where `height` is largest.
template <class Height>
Vec3 climb(const cad::Model& model, const CuttingPlane& plane, const CutPoint& start, double length,
           const Height& height) {
  // Facets turn by some twenty degrees at a nose: its highest point is within a step of theirs. What climbs
  // by more than `most_gain` has left the face over its border, where the surface may go on. Of the length.
  constexpr double first_step = 4e-3, last_step = 1e-4, most_gain = 1e-3;
  const auto onto = [&](Vec3 p, Vec2 guess) {
    cad::Projection found = model.project(start.face, p, guess);
    return model.project(
        start.face, found.point - dot(found.point - plane.origin, plane.normal) * plane.normal, found.uv);
  };
  const double limit = height(start.point) + most_gain * length;
  Vec3 best = start.point;
  Vec2 uv = start.uv;
  double highest = height(best);
  for (double step = first_step * length; step > last_step * length; step *= 0.5) {
    for (const double way : {-step, step}) {
      const Vec3 normal = model.face_frame(start.face, uv).normal;
      const Vec3 along = cross(normal, plane.normal);
      if (!(norm(along) > 0)) continue;
      const cad::Projection next = onto(best + way * normalized(along), uv);
      const double now = height(next.point);
      if (!next.converged || !(now > highest) || now > limit) continue;
      best = next.point, uv = next.uv, highest = now;
    }
  }
  return best;
}

/// The highest point of some cuts, on the CAD surface of every face that comes close to it.
template <class Height>
Vec3 highest_point(const cad::Model& model, const CuttingPlane& plane, const std::vector<CutFacet>& cuts,
                   double length, const Height& height) {
  constexpr double close = 0.01;  // of the length: what the facets of two faces differ by, at a nose
  const CutPoint* top = nullptr;
  for (const CutFacet& cut : cuts) {
    for (const CutPoint& end : cut.ends)
      if (top == nullptr || height(end.point) > height(top->point)) top = &end;
  }
  Vec3 best = top->point;
  std::vector<cad::FaceId> done;
  for (const CutFacet& cut : cuts) {
    const CutPoint& end = height(cut.ends[0].point) > height(cut.ends[1].point) ? cut.ends[0] : cut.ends[1];
    if (distance(end.point, top->point) > close * length ||
        std::find(done.begin(), done.end(), end.face) != done.end())
      continue;
    const CutPoint* start = end.face == top->face ? top : &end;
    done.push_back(end.face);
    const Vec3 found = climb(model, plane, *start, length, height);
    if (height(found) > height(best)) best = found;
  }
  return best;
}

}  // namespace

std::optional<Nose> find_nose(const cad::Model& model, const std::vector<ModelFacet>& skin,
                              const CuttingPlane& plane, double gap) {
  const std::vector<CutFacet> cuts = connected(cut_skin(skin, plane), plane.origin, gap);
  double reach = 0;
  for (const CutFacet& cut : cuts) reach = std::max(reach, cut.last);
  if (!(reach > 0)) return std::nullopt;
  const auto height = [&](Vec3 p) { return distance(p, plane.origin); };
  Nose nose{highest_point(model, plane, cuts, reach, height)};
  const Vec3 across = cross(plane.normal, normalized(nose.place - plane.origin));
  double low = 0, high = 0;
  for (const CutFacet& cut : cuts) {
    for (const CutPoint& end : cut.ends) {
      const double off = dot(end.point - plane.origin, across);
      low = std::min(low, off), high = std::max(high, off);
    }
  }
  nose.thickness = high - low;
  return nose;
}

std::optional<Vec3> find_nose_near(const cad::Model& model, const std::vector<ModelFacet>& skin,
                                   const CuttingPlane& plane, Vec3 guess, double reach) {
  std::vector<CutFacet> cuts = cut_skin(skin, plane);
  std::erase_if(cuts, [&](const CutFacet& cut) {
    return distance(cut.ends[0].point, guess) > reach || distance(cut.ends[1].point, guess) > reach;
  });
  if (cuts.empty()) return std::nullopt;
  const double length = distance(guess, plane.origin);
  return highest_point(model, plane, cuts, length, [&](Vec3 p) { return distance(p, plane.origin); });
}

}  // namespace aeroloom::sizing
