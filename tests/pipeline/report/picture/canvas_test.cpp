#include "pipeline/report/picture/canvas.hpp"

#include "pipeline/report/picture/camera.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::picture {
namespace {

constexpr Colour red{200, 0, 0}, blue{0, 0, 200};

/// Samples of one colour; of any colour but none without one.
int samples_of(const Canvas& canvas, Colour colour) {
  int count = 0;
  for (int y = 0; y < canvas.height(); ++y) {
    for (int i = 0; i < canvas.width() * Canvas::samples; ++i) {
      const std::uint64_t sample = canvas.row(y)[i];
      count += sample != Canvas::nothing && Canvas::colour_of(sample) == colour;
    }
  }
  return count;
}

std::vector<std::uint64_t> all_samples(const Canvas& canvas) {
  return {canvas.row(0), canvas.row(0) + canvas.width() * canvas.height() * Canvas::samples};
}

TEST(CanvasLocal, TrianglesCoverTheirArea) {
  Canvas canvas(100, 80);
  canvas.draw_triangle({{{10, 10, 0}, {90, 20, 0}, {30, 70, 0}}}, {red, red});
  const double area = 0.5 * (80 * 60 - 10 * 20);
  EXPECT_NEAR(samples_of(canvas, red), Canvas::samples * area, 0.01 * Canvas::samples * area);
}

TEST(CanvasLocal, NeighboursLeaveNoCracksAndFillWhatTheyShare) {
  Canvas canvas(64, 64);
  const ScreenPoint centre{31.3, 30.7, 0};
  constexpr int blades = 37;
  const auto rim = [&](int i) {
    const double angle = 2 * M_PI * i / blades;
    return ScreenPoint{32 + 100 * std::cos(angle), 32 + 100 * std::sin(angle), 0};
  };
  for (int i = 0; i < blades; ++i) {
    canvas.draw_triangle({{centre, rim(i), rim((i + 1) % blades)}}, {red, red});
  }
  EXPECT_EQ(samples_of(canvas, red), 64 * 64 * Canvas::samples);
}

TEST(CanvasLocal, TheNearestIsSeenWhateverTheOrder) {
  const std::array<ScreenPoint, 3> tilted = {{{0, 0, -10}, {40, 0, 10}, {0, 40, -10}}};
  const std::array<ScreenPoint, 3> flat = {{{0, 0, 0}, {40, 0, 0}, {0, 40, 0}}};
  Canvas one(40, 40), other(40, 40);
  one.draw_triangle(tilted, {red, red});
  one.draw_triangle(flat, {blue, blue});
  other.draw_triangle(flat, {blue, blue});
  other.draw_triangle(tilted, {red, red});
  EXPECT_EQ(all_samples(one), all_samples(other));
  EXPECT_EQ(Canvas::colour_of(one.row(5)[5 * Canvas::samples]), red);    // nearer on the left
  EXPECT_EQ(Canvas::colour_of(one.row(5)[30 * Canvas::samples]), blue);  // farther on the right
}

TEST(CanvasLocal, EqualDepthsGoToTheDarkerWhateverTheOrder) {
  const std::array<ScreenPoint, 3> corners = {{{0, 0, 3}, {20, 0, 3}, {0, 20, 3}}};
  for (const bool is_red_first : {true, false}) {
    Canvas canvas(20, 20);
    canvas.draw_triangle(corners, is_red_first ? TriangleStyle{red, red} : TriangleStyle{blue, blue});
    canvas.draw_triangle(corners, is_red_first ? TriangleStyle{blue, blue} : TriangleStyle{red, red});
    EXPECT_EQ(samples_of(canvas, red), 0);
    EXPECT_GT(samples_of(canvas, blue), 0);
  }
}

TEST(CanvasLocal, LinesRunAlongTheEdgesAskedFor) {
  Canvas canvas(60, 60);
  TriangleStyle style{red, blue, 4};
  style.line_opacity = {1, 0, 0};
  canvas.draw_triangle({{{5, 5, 0}, {55, 5, 0}, {5, 55, 0}}}, style);
  EXPECT_EQ(Canvas::colour_of(canvas.row(5)[30 * Canvas::samples]), blue);
  EXPECT_EQ(Canvas::colour_of(canvas.row(30)[5 * Canvas::samples + 1]), red);
  EXPECT_NEAR(samples_of(canvas, blue), Canvas::samples * 50 * 2, Canvas::samples * 50);
}

TEST(CanvasLocal, LinesHaveTheirWidthAndStandInFront) {
  Canvas canvas(60, 60);
  canvas.draw_triangle({{{-100, -100, 0}, {300, -100, 0}, {-100, 300, 0}}}, {red, red});
  canvas.draw_line({10, 30, 0}, {50, 30, 0}, 6, blue, 1);
  EXPECT_NEAR(samples_of(canvas, blue), Canvas::samples * (40 * 6 + M_PI * 9), Canvas::samples * 12);
  canvas.draw_line({10, 10, 5}, {50, 10, 5}, 6, Colour{0, 200, 0}, 1);
  EXPECT_EQ(samples_of(canvas, Colour{0, 200, 0}), 0) << "behind the triangle";
}

TEST(CanvasLocal, NothingIsDrawnOutsideOfTheWindowOrTooNear) {
  Canvas canvas(40, 40);
  const std::array<ScreenPoint, 3> everywhere = {{{-1e9, -1e9, 0}, {3e9, -1e9, 0}, {-1e9, 3e9, 0}}};
  canvas.set_window({10, 10, 5, 7});
  canvas.draw_triangle(everywhere, {red, red});
  EXPECT_EQ(samples_of(canvas, red), 5 * 7 * Canvas::samples);
  canvas.set_window({0, 0, 40, 40});
  canvas.set_nearest(1);
  canvas.draw_triangle(everywhere, {blue, blue});
  EXPECT_EQ(samples_of(canvas, blue), 0);
}

TEST(CanvasLocal, DegenerateTrianglesAndStrangeNumbersDrawNothing) {
  Canvas canvas(20, 20);
  const double nan = std::nan("");
  canvas.draw_triangle({{{1, 1, 0}, {5, 5, 0}, {9, 9, 0}}}, {red, red});
  canvas.draw_triangle({{{nan, 1, 0}, {5, nan, 0}, {9, 2, 0}}}, {red, red});
  canvas.draw_line({nan, 1, 0}, {5, nan, 0}, 2, red, 0);
  EXPECT_EQ(samples_of(canvas, red), 0);
}

TEST(CameraLocal, FramesWhatIsToBeSeen) {
  const Viewpoint view = look_from({-1, -1, 0.5}, {0, 0, 1});
  EXPECT_NEAR(dot(view.right, view.up), 0, 1e-15);
  EXPECT_GT(view.up.z, 0.8);
  geometry::Box seen;
  const geometry::Vec3 corner{3, 4, 5};
  seen.add(in_view(view, corner));
  seen.add(in_view(view, {-1, -2, 0}));
  const Camera camera = frame(view, seen, {100, 50, 200, 100}, 10);
  for (const geometry::Vec3 p : {corner, geometry::Vec3{-1, -2, 0}}) {
    const ScreenPoint s = camera.project(p);
    EXPECT_TRUE(s.x > 109.9 && s.x < 290.1 && s.y > 59.9 && s.y < 140.1) << s.x << ' ' << s.y;
  }
}

TEST(CameraLocal, LooksAlongTheUpwardDirectionToo) {
  const Viewpoint view = look_from({0, 0, 1}, {0, 0, 1});
  EXPECT_NEAR(norm(view.right), 1, 1e-15);
  EXPECT_NEAR(norm(view.up), 1, 1e-15);
}

}  // namespace
}  // namespace aeroloom::picture
