/// The canvas: triangles and lines with hidden-surface removal.
///
/// Each pixel has four samples; a sample is one number with the depth in the upper and the colour in the
/// lower bits. The smaller of two numbers wins. So the picture is a minimum and independent of drawing order
/// and ranks. At equal depth the darker colour wins. Borders belong to triangles, so neighbours leave no
/// cracks.
#pragma once

#include "pipeline/report/picture/colour.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::picture {

/// A point in pixels from the left and from the top; depth in pixels, away from the viewer.
struct ScreenPoint {
  double x = 0, y = 0, depth = 0;
};

/// A rectangle of pixels.
struct Window {
  int left = 0, top = 0, width = 0, height = 0;
};

/// Filling of a triangle, and lines along its edges.
struct TriangleStyle {
  Colour fill;
  Colour line;
  double line_width = 0;                           ///< in pixels; half of it lies on this side of the edge
  std::array<double, 3> line_opacity = {0, 0, 0};  ///< of the edge from corner i to corner i + 1
};

class Canvas {
public:
  static constexpr int samples = 4;  // per pixel, against jagged edges
  static constexpr std::uint64_t nothing = ~std::uint64_t{0};

  /// An empty canvas of 8 * samples bytes per pixel.
  Canvas(int width, int height);

  int width() const { return _width; }
  int height() const { return _height; }
  /// Restricts drawing to the window; initially the whole canvas.
  void set_window(Window window) { _window = window; }
  /// Clips everything nearer than this depth; initially nothing.
  void set_nearest(double depth) { _nearest = depth; }

  void draw_triangle(const std::array<ScreenPoint, 3>& corners, const TriangleStyle& style);
  /// A line with round ends, moved `raised` pixels towards the viewer.
  void draw_line(ScreenPoint a, ScreenPoint b, double width, Colour colour, double raised);

  /// The samples of a pixel row, counted from the top: width() * samples numbers.
  std::uint64_t* row(int y) { return _samples.data() + first_of_row(y); }
  const std::uint64_t* row(int y) const { return _samples.data() + first_of_row(y); }
  static Colour colour_of(std::uint64_t sample) {
    return {static_cast<std::uint8_t>(sample >> 16), static_cast<std::uint8_t>(sample >> 8),
            static_cast<std::uint8_t>(sample)};
  }

private:
  std::size_t first_of_row(int y) const { return static_cast<std::size_t>(y) * _width * samples; }
  void put(std::uint64_t& sample, double depth, Colour colour) const;

  int _width, _height;
  Window _window;
  double _nearest;
  std::vector<std::uint64_t> _samples;
};

}  // namespace aeroloom::picture
