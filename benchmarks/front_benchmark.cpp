/// The front kernel alone: a disk and a square under uniform and graded sizes.
#include "mesh/quality/quality.hpp"
#include "surface/front/front.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <string>

namespace {

using aeroloom::front::FrontInput;
using aeroloom::front::FrontResult;
using aeroloom::geometry::Vec2;
using Size = std::function<double(Vec2)>;

/// A closed curve given by a function on [0,1], discretised under the sizes.
FrontInput discretise(const std::function<Vec2(double)>& curve, const Size& size) {
  constexpr int samples = 1000000;
  double length = 0;  // in sizes
  const auto step = [&](int i) {
    const Vec2 a = curve(double(i) / samples), b = curve(double(i + 1) / samples);
    return distance(a, b) / size(0.5 * (a + b));
  };
  for (int i = 0; i < samples; ++i) length += step(i);
  const int edges = std::max(3, static_cast<int>(std::lround(length)));
  FrontInput input;
  double walked = 0;
  for (int i = 0; i < samples; ++i) {
    if (walked * edges >= length * static_cast<double>(input.points.size()))
      input.points.push_back(curve(double(i) / samples));
    walked += step(i);
  }
  const auto count = static_cast<std::int32_t>(input.points.size());
  for (std::int32_t i = 0; i < count; ++i) input.edges.push_back({i, (i + 1) % count});
  return input;
}

void report(const char* name, const FrontInput& input, const FrontResult& result, const Size& size,
            double seconds) {
  double quality = 0, worst = 1, angle = 180, expected = 0;
  for (const auto& t : result.triangles) {
    const Vec2 p[3] = {result.points[t[0]], result.points[t[1]], result.points[t[2]]};
    const aeroloom::geometry::Vec3 a{p[0].x, p[0].y, 0}, b{p[1].x, p[1].y, 0}, c{p[2].x, p[2].y, 0};
    const double q = aeroloom::mesh::triangle_mean_ratio(a, b, c), h = size((p[0] + p[1] + p[2]) / 3.0);
    quality += q;
    worst = std::min(worst, q);
    angle = std::min(angle, aeroloom::mesh::smallest_angle(a, b, c));
    expected += 0.5 * cross(p[1] - p[0], p[2] - p[0]) * 4 / (std::numbers::sqrt3 * h * h);
  }
  const auto count = static_cast<double>(result.triangles.size());
  std::printf(
      "RESULT benchmark=front case=%s boundary_edges=%zu triangles=%zu seconds=%.3f "
      "triangles_per_second=%.0f "
      "mean_quality=%.4f worst_quality=%.4f min_angle_deg=%.2f count_ratio=%.4f\n",
      name, input.edges.size(), result.triangles.size(), seconds, count / seconds, quality / count, worst,
      angle, count / expected);
}

void run(const char* name, const std::function<Vec2(double)>& curve, const Size& size) {
  const FrontInput input = discretise(curve, size);
  const auto start = std::chrono::steady_clock::now();
  const FrontResult result =
      aeroloom::front::fill_front(input, [&](Vec2 p, std::int32_t&) { return size(p); });
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
  report(name, input, result, size, time.count());
}

Vec2 circle(double s) {
  return {std::cos(2 * std::numbers::pi * s), std::sin(2 * std::numbers::pi * s)};
}

Vec2 square(double s) {
  const double t = 4 * s;
  if (t < 1) return {t, 0};
  if (t < 2) return {1, t - 1};
  if (t < 3) return {3 - t, 1};
  return {0, 4 - t};
}

}  // namespace

/// Usage: front_benchmark [triangles of the uniform disk, default 500000]
int main(int argc, char** argv) {
  const double triangles = argc > 1 ? std::atof(argv[1]) : 500000;
  const double h = std::sqrt(4 * std::numbers::pi / (std::numbers::sqrt3 * triangles));
  run("disk_uniform", circle, [&](Vec2) { return h; });
  run("square_uniform", square, [&](Vec2) { return h / std::sqrt(std::numbers::pi); });
  run("disk_graded", circle, [&](Vec2 p) { return h * (0.2 + 2.5 * distance(p, {0.3, 0.2})); });
  run("square_graded", square, [&](Vec2 p) { return 0.6 * h + 2 * h * distance(p, {0, 0}); });
  run("square_thousandfold", square, [&](Vec2 p) { return 5e-5 + 12 * h * distance(p, {0.5, 0.5}); });
}
