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
  const Vec3 p = (first - a) - dot(first - a, along) * along,
             q = (second - a) - dot(second - a, along) * along;
  const double angle = std::atan2(dot(along, cross(q, p)), dot(p, q)) * 180 / std::numbers::pi;
  return angle < 0 ? angle + 360 : angle;
}

/// An edge of a piece where different interfaces, or an interface and the surface, meet.
struct Hinge {
  LocalIndex a, b;              // ends of the edge, ascending
  std::int32_t along, against;  // the triangle that runs from a to b, and the other one
  LocalIndex along_apex, against_apex;
  double angle;  // degrees, inside
};

/// Calls visit(hinge) for all of them but those where the piece touches itself.
template <class Visit>
void for_each_hinge(const PieceBoundary& boundary, const VolumePlan& plan, const MergedParts& parts,
                    std::int32_t part, const Visit& visit) {
  struct Side {
    LocalIndex low, high;
    std::int32_t triangle;
    bool along;
    LocalIndex apex;
  };
  const auto& triangles = boundary.surface.triangles;
  std::vector<Side> sides;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const LocalIndex a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      sides.push_back(
          {std::min(a, b), std::max(a, b), static_cast<std::int32_t>(t), a < b, triangles[t][(k + 2) % 3]});
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
  for (std::size_t i = 0, j = 0; i < sides.size(); i = j) {
    while (j < sides.size() && sides[j].low == sides[i].low && sides[j].high == sides[i].high) ++j;
    if (j - i != 2 || beyond(sides[i].triangle) == beyond(sides[i + 1].triangle)) continue;
    const Side& s = sides[i].along ? sides[i] : sides[i + 1];
    const Side& t = sides[i].along ? sides[i + 1] : sides[i];
    const auto& x = boundary.surface.points;
    visit(Hinge{s.low, s.high, s.triangle, t.triangle, s.apex, t.apex,
                inner_angle(x[s.low], x[s.high], x[s.apex], x[t.apex])});
  }
}

/// A point turned around the line through a and b, counter-clockwise seen from b.
Vec3 turned(Vec3 p, Vec3 a, Vec3 b, double degrees) {
  const Vec3 along = normalized(b - a);
  const Vec3 foot = a + dot(p - a, along) * along, out = p - foot;
  const double angle = degrees * std::numbers::pi / 180;
  return foot + std::cos(angle) * out + std::sin(angle) * cross(along, out);
}

}  // namespace

std::vector<InterfaceCorner> find_interface_corners(const PieceBoundary& boundary, const VolumePlan& plan,
                                                    const MergedParts& parts, std::int32_t part) {
  std::vector<InterfaceCorner> corners;
  for_each_hinge(boundary, plan, parts, part, [&](const Hinge& h) {
    const bool on_surface = boundary.vertex_dimension[h.a] < 3 && boundary.vertex_dimension[h.b] < 3;
    corners.push_back({boundary.vertex_number[h.a], boundary.vertex_number[h.b], part, on_surface, h.angle,
                       0.5 * (boundary.surface.points[h.a] + boundary.surface.points[h.b])});
  });
  return corners;
}

std::vector<VertexWish> wish_wider_angles(const PieceBoundary& boundary, const VolumePlan& plan,
                                          const MergedParts& parts, std::int32_t part, double wanted) {
  std::vector<VertexWish> wishes;
  const auto& x = boundary.surface.points;
  for_each_hinge(boundary, plan, parts, part, [&](const Hinge& h) {
    if (h.angle >= wanted) return;
    const bool first = boundary.vertex_dimension[h.along_apex] == 3;
    const bool second = boundary.vertex_dimension[h.against_apex] == 3;
    if (!first && !second) return;
    const double turn = (wanted - h.angle) / (first && second ? 2 : 1);
    const auto wish = [&](LocalIndex v, double degrees) {
      wishes.push_back({boundary.vertex_number[v], part, 0, turned(x[v], x[h.a], x[h.b], degrees) - x[v]});
    };
    // Outward triangles: the inside lies clockwise of the one that runs along, seen from b.
    if (first) wish(h.along_apex, turn);
    if (second) wish(h.against_apex, -turn);
  });
  return wishes;
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
