#include "pipeline/interface_angles.hpp"

#include "mesh/delivery.hpp"
#include "mesh/findings.hpp"
#include "mesh/mixing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aeroloom::pipeline {
namespace {

using geometry::Vec3;
using mesh::LocalIndex;

constexpr std::size_t most_listed = 20;

/// The angle on the inner side of two outward triangles at the edge (a,b), the first one running from a to b.
double inner_angle(Vec3 a, Vec3 b, Vec3 first, Vec3 second) {
  const Vec3 along = normalized(b - a);
  const Vec3 p = (first - a) - dot(first - a, along) * along, q = (second - a) - dot(second - a, along) * along;
  const double angle = std::atan2(dot(along, cross(q, p)), dot(p, q)) * 180 / std::numbers::pi;
  return angle < 0 ? angle + 360 : angle;
}

}  // namespace

std::vector<InterfaceCorner> find_interface_corners(const PieceBoundary& boundary, const VolumePlan& plan,
                                                    const MergedParts& parts, std::int32_t part) {
  struct Side {
    LocalIndex low, high;
    std::int32_t triangle;
  };
  const auto& triangles = boundary.surface.triangles;
  std::vector<Side> sides;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const LocalIndex a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), static_cast<std::int32_t>(t)});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& s, const Side& t) {
    return s.low != t.low ? s.low < t.low : s.high != t.high ? s.high < t.high : s.triangle < t.triangle;
  });
  const auto beyond = [&](std::int32_t t) {
    const std::int32_t f = boundary.triangle_interface[t];
    if (f < 0) return -1;
    const std::int32_t a = parts.root(plan.faces[f].part), b = parts.root(plan.faces[f].beyond);
    return a == part ? b : a;
  };
  std::vector<InterfaceCorner> corners;
  for (std::size_t i = 0, j = 0; i < sides.size(); i = j) {
    while (j < sides.size() && sides[j].low == sides[i].low && sides[j].high == sides[i].high) ++j;
    if (j - i != 2) continue;
    std::int32_t s = sides[i].triangle, t = sides[i + 1].triangle;
    if (beyond(s) == beyond(t)) continue;
    const LocalIndex a = sides[i].low, b = sides[i].high;
    const auto runs_along = [&](std::int32_t triangle) {
      for (int k = 0; k < 3; ++k) {
        if (triangles[triangle][k] == a && triangles[triangle][(k + 1) % 3] == b) return true;
      }
      return false;
    };
    if (!runs_along(s)) std::swap(s, t);
    const auto apex = [&](std::int32_t triangle) {
      const auto& v = triangles[triangle];
      return boundary.surface.points[v[0] != a && v[0] != b ? v[0] : v[1] != a && v[1] != b ? v[1] : v[2]];
    };
    const Vec3 x = boundary.surface.points[a], y = boundary.surface.points[b];
    const bool on_surface = boundary.triangle_face[s] >= 0 || boundary.triangle_face[t] >= 0 ||
                            (boundary.vertex_dimension[a] < 3 && boundary.vertex_dimension[b] < 3);
    corners.push_back({boundary.vertex_number[a], boundary.vertex_number[b], part, on_surface,
                       inner_angle(x, y, apex(s), apex(t)), 0.5 * (x + y)});
  }
  return corners;
}

InterfaceAngles summarise_interfaces(const parallel::Communicator& communicator,
                                     const std::vector<InterfaceCorner>& corners) {
  std::vector<InterfaceCorner> met = mesh::deliver(communicator, corners, [&](const InterfaceCorner& c) {
    const std::uint64_t mixed =
        mesh::mix_in(static_cast<std::uint64_t>(c.low), static_cast<std::uint64_t>(c.high));
    return mesh::meeting_rank(mixed, communicator.size());
  });
  std::sort(met.begin(), met.end(), [](const InterfaceCorner& a, const InterfaceCorner& b) {
    return a.low != b.low ? a.low < b.low : a.high != b.high ? a.high < b.high : a.part < b.part;
  });
  InterfaceAngles result;
  std::vector<SharpInterface> sharp;
  for (std::size_t i = 0, j = 0; i < met.size(); i = j) {
    double smallest = 360, sum = 0;
    bool on_surface = false;
    for (; j < met.size() && met[j].low == met[i].low && met[j].high == met[i].high; ++j) {
      smallest = std::min(smallest, met[j].angle);
      sum += met[j].angle;
      on_surface = on_surface || met[j].on_surface;
    }
    ++result.edges;
    ++result.histogram[std::min<std::size_t>(17, static_cast<std::size_t>(smallest / 10))];
    result.smallest = std::min(result.smallest, smallest);
    if (smallest >= InterfaceAngles::threshold) continue;
    ++result.below;
    if (on_surface && sum < 2 * InterfaceAngles::threshold) ++result.forced;
    sharp.push_back({met[i].middle, smallest, sum});
  }
  result.edges = communicator.sum(result.edges);
  result.below = communicator.sum(result.below);
  result.forced = communicator.sum(result.forced);
  result.smallest = communicator.minimum(result.smallest);
  for (std::int64_t& count : result.histogram) count = communicator.sum(count);
  const auto sharper = [](const SharpInterface& a, const SharpInterface& b) {
    return a.angle != b.angle ? a.angle < b.angle : a.point.x < b.point.x;
  };
  std::sort(sharp.begin(), sharp.end(), sharper);
  if (sharp.size() > most_listed) sharp.resize(most_listed);
  result.sharpest = communicator.all_gather_items<SharpInterface>(sharp);
  std::sort(result.sharpest.begin(), result.sharpest.end(), sharper);
  if (result.sharpest.size() > most_listed) result.sharpest.resize(most_listed);
  return result;
}

}  // namespace aeroloom::pipeline
