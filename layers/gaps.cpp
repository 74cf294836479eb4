#include "layers/gaps.hpp"

#include "geometry/box_tree.hpp"
#include "geometry/sort_unique.hpp"
#include "parallel/communication/deliver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>

namespace aeroloom::layers {
namespace {

using geometry::Box;
using geometry::Vec3;

/// Balls whose common box is sent to other ranks. Chosen, not measured.
constexpr int balls_per_batch = 256;
constexpr int boxes_per_leaf_of_gaps = 4;  // chosen, not measured

/// A triangle on its way to a rank with balls.
struct NearTriangle {
  Vec3 corners[3];
  Vec3 plane;  ///< normal out of the fluid where layers end on the triangle's plane, else zero
  std::int64_t rank;

  static constexpr auto fields() {
    return std::tuple(&NearTriangle::corners, &NearTriangle::plane, &NearTriangle::rank);
  }
};

/// A box around balls of a rank.
struct BallBatch {
  Box box;
  std::int64_t rank;
};

/// The point of a triangle that is nearest to p: inside, on an edge, or a corner (Ericson, Real-Time
/// Collision Detection, 2005, section 5.1.5).
Vec3 nearest_point(Vec3 p, const Vec3 (&t)[3]) {
  const Vec3 ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0], bp = p - t[1], cp = p - t[2];
  const double ab_ap = dot(ab, ap), ac_ap = dot(ac, ap);
  if (ab_ap <= 0 && ac_ap <= 0) return t[0];
  const double ab_bp = dot(ab, bp), ac_bp = dot(ac, bp);
  if (ab_bp >= 0 && ac_bp <= ab_bp) return t[1];
  const double of_c = ab_ap * ac_bp - ab_bp * ac_ap;
  if (of_c <= 0 && ab_ap >= 0 && ab_bp <= 0) return t[0] + (ab_ap / (ab_ap - ab_bp)) * ab;
  const double ab_cp = dot(ab, cp), ac_cp = dot(ac, cp);
  if (ac_cp >= 0 && ab_cp <= ac_cp) return t[2];
  const double of_b = ab_cp * ac_ap - ab_ap * ac_cp;
  if (of_b <= 0 && ac_ap >= 0 && ac_cp <= 0) return t[0] + (ac_ap / (ac_ap - ac_cp)) * ac;
  const double of_a = ab_bp * ac_cp - ab_cp * ac_bp, along_b = ac_bp - ab_bp, along_c = ab_cp - ac_cp;
  if (of_a <= 0 && along_b >= 0 && along_c >= 0)
    return t[1] + (along_b / (along_b + along_c)) * (t[2] - t[1]);
  const double sum = of_a + of_b + of_c;
  return t[0] + (of_b / sum) * ab + (of_c / sum) * ac;
}

/// A lower bound of diameter_beside for all triangles in the box.
double least_diameter(const TouchingBall& ball, const Box& box) {
  double squared = 0, ahead = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.low[axis] - ball.point[axis], high = box.high[axis] - ball.point[axis];
    const double off = std::max({low, 0.0, -high});
    squared += off * off;
    ahead += std::max(low * ball.direction[axis], high * ball.direction[axis]);
  }
  if (ahead <= 0) return std::numeric_limits<double>::infinity();
  return ahead * ahead < squared ? squared / ahead : std::sqrt(squared);  // the larger of the two
}

Box box_of_ball(const TouchingBall& ball) {
  const double radius = 0.5 * ball.diameter;
  const Vec3 center = ball.point + radius * ball.direction;
  return Box{center, center}.dilated(radius);
}

/// Calls visit(box) for a box around each part of the boxes. Parts end where most of the way along the
/// longest axis is between two of them: a box around balls at both ends of a wing would hold all of it.
template <class Visit>
void visit_parts(const std::vector<Box>& boxes, std::span<std::int32_t> part, const Visit& visit) {
  constexpr double least_gap = 0.5;  // of the way; chosen, not measured
  Box middles, all;
  for (const std::int32_t i : part) middles.add(boxes[i].center()), all.add(boxes[i]);
  const Vec3 way = middles.high - middles.low;
  const int axis = way.x >= way.y && way.x >= way.z ? 0 : way.y >= way.z ? 1 : 2;
  const auto at = [&](std::int32_t i) { return boxes[i].center()[axis]; };
  std::sort(part.begin(), part.end(), [&](std::int32_t i, std::int32_t j) { return at(i) < at(j); });
  std::size_t widest = 0;
  for (std::size_t k = 1; k < part.size(); ++k) {
    if (widest == 0 || at(part[k]) - at(part[k - 1]) > at(part[widest]) - at(part[widest - 1])) widest = k;
  }
  const auto gap = [&](std::size_t k) { return boxes[part[k]].low[axis] - boxes[part[k - 1]].high[axis]; };
  if (widest == 0 || gap(widest) <= least_gap * way[axis]) return visit(all);
  visit_parts(boxes, part.first(widest), visit);
  visit_parts(boxes, part.subspan(widest), visit);
}

/// The boxes of the balls of all ranks, some hundred balls each.
std::vector<BallBatch> gather_batches(const LocalWall& wall, const std::vector<TouchingBall>& balls) {
  std::vector<Box> boxes;
  for (const TouchingBall& ball : balls) {
    if (ball.diameter > 0) boxes.push_back(box_of_ball(ball));
  }
  const geometry::BoxTree tree(boxes, balls_per_batch);
  std::vector<BallBatch> batches;
  for (const auto leaf : tree.leaves()) {
    std::vector<std::int32_t> part(leaf.begin(), leaf.end());
    visit_parts(boxes, part, [&](const Box& box) {
      batches.push_back({box, wall.mesh.communicator.rank()});
    });
  }
  return wall.mesh.communicator.all_gather_items(std::span<const BallBatch>(batches));
}

/// The triangles of this rank, and those of others that its balls may meet.
std::vector<NearTriangle> fetch_triangles(const LocalWall& wall, const std::vector<BallBatch>& batches) {
  std::vector<Box> boxes;
  boxes.reserve(batches.size());
  for (const BallBatch& batch : batches) boxes.push_back(batch.box);
  const geometry::BoxTree tree(boxes, boxes_per_leaf_of_gaps);
  std::vector<NearTriangle> triangles;
  std::vector<std::int64_t> ranks;
  for (std::int32_t t = 0; t < wall.triangle_count(); ++t) {
    const auto& [a, b, c] = wall.triangles[t];
    NearTriangle triangle{{wall.points[a], wall.points[b], wall.points[c]}, {}, 0};
    if (wall.roles[t] == WallRole::plane) {
      triangle.plane =
          wall.is_curved_end(wall.faces[t])
              ? -normalized(cross(wall.points[b] - wall.points[a], wall.points[c] - wall.points[a]))
              : wall.end_planes[wall.faces[t]];
    }
    Box box;
    for (const Vec3 corner : triangle.corners) box.add(corner);
    ranks.clear();
    geometry::for_each_overlap(tree, boxes, box, [&](std::int32_t i) { ranks.push_back(batches[i].rank); });
    geometry::sort_unique(ranks);
    for (const std::int64_t rank : ranks) {
      triangle.rank = rank;
      triangles.push_back(triangle);
    }
  }
  return parallel::deliver(wall.mesh.communicator, std::move(triangles),
                           [](const NearTriangle& t) { return static_cast<parallel::Rank>(t.rank); });
}

/// Next to a plane that layers end on, the opposite column is the mirror image. A column that leans towards
/// the plane meets it at twice the distance to the plane in its direction.
double gap_before(const TouchingBall& ball, const NearTriangle& triangle) {
  const double through = diameter_beside(ball, triangle.corners);
  if (triangle.plane == Vec3{} || through == ball.diameter) return through;
  const double towards = dot(ball.direction, triangle.plane);
  return towards > 0 ? std::min(ball.diameter, through * (1 + towards) / towards) : ball.diameter;
}

}  // namespace

double diameter_beside(const TouchingBall& ball, const Vec3 (&triangle)[3]) {
  constexpr int most_steps = 30;
  // Sine of half the turn of a concave edge; chosen, no other was tried.
  constexpr double least_ahead = 0.4;
  constexpr double converged = 1 - 1e-6;  // of the diameter before: a gap is no exact measure
  double diameter = ball.diameter;
  for (int step = 0; step < most_steps; ++step) {
    const Vec3 way = nearest_point(ball.point + 0.5 * diameter * ball.direction, triangle) - ball.point;
    const double ahead = dot(way, ball.direction);
    if (!(ahead > 0)) return diameter;
    const double through = dot(way, way) / ahead;
    if (!(through < diameter)) return diameter;
    if (ahead < least_ahead * norm(way)) return ball.diameter;
    const bool last = through > converged * diameter;
    diameter = through;
    if (last) return diameter;
  }
  return diameter;
}

std::vector<double> find_gaps(const LocalWall& wall, const std::vector<TouchingBall>& balls) {
  const std::vector<NearTriangle> triangles = fetch_triangles(wall, gather_batches(wall, balls));
  std::vector<Box> boxes(triangles.size());
  for (std::size_t t = 0; t < boxes.size(); ++t) {
    for (const Vec3 corner : triangles[t].corners) boxes[t].add(corner);
  }
  const geometry::BoxTree tree(boxes, boxes_per_leaf_of_gaps);
  std::vector<double> gaps(balls.size(), 0);
  for (std::size_t b = 0; b < balls.size(); ++b) {
    const TouchingBall& ball = balls[b];
    if (ball.diameter == 0) continue;
    // Rounding must not decide which triangles are tested: the tree depends on ranks.
    constexpr double beyond_rounding = 1 + 1e-9;
    double bound = beyond_rounding * ball.diameter;
    gaps[b] = ball.diameter;
    tree.search_nearest([&](const Box& box) { return least_diameter(ball, box); }, bound,
                        [&](std::int32_t place) {
                          const NearTriangle& triangle = triangles[tree.order()[place]];
                          const auto& corners = triangle.corners;
                          if (least_diameter(ball, boxes[tree.order()[place]]) > bound) return;
                          if (std::count(corners, corners + 3, ball.point) != 0) return;
                          gaps[b] = std::min(gaps[b], gap_before(ball, triangle));
                          bound = beyond_rounding * gaps[b];
                        });
  }
  return gaps;
}

}  // namespace aeroloom::layers
