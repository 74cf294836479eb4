/// The canvas: triangles and lines on it, the nearest in front.
///
/// A pixel has four samples, each one number: depth above, colour below. Of two fragments the lower number
/// stays; so what is seen is a minimum, which does not depend on the order in which things are drawn nor on
/// who draws them. Equal depths go to the darker colour. Borders of triangles count as inside, so there are
/// no cracks between neighbours.
#pragma once

#include "pipeline/report/picture/colour.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::picture {

/// A point on the canvas: pixels from the left and from the top; depth in pixels away from the viewer.
struct ScreenPoint {
  double x = 0, y = 0, depth = 0;
};

/// A rectangle of pixels.
struct Window {
  int left = 0, top = 0, width = 0, height = 0;
};

/// How a triangle is filled and which of its edges have a line.
struct TriangleStyle {
  Colour fill;
  Colour line;
  double line_width = 0;                           ///< pixels, half of it on this side of the edge
  std::array<double, 3> line_opacity = {0, 0, 0};  ///< of the edge from corner i to corner i + 1
};

class Canvas {
public:
  static constexpr int samples = 4;  // of a pixel each: edges are smooth to the eye
  static constexpr std::uint64_t nothing = ~std::uint64_t{0};

  /// Empty. 8 samples bytes a pixel.
  Canvas(int width, int height);

  int width() const { return _width; }
  int height() const { return _height; }
  /// Nothing is drawn outside of the window; at first it is the whole canvas.
  void set_window(Window window) { _window = window; }
  /// Nothing is drawn nearer than this; at first all is.
  void set_nearest(double depth) { _nearest = depth; }

  void draw_triangle(const std::array<ScreenPoint, 3>& corners, const TriangleStyle& style);
  /// A line with round ends. It stands `raised` pixels nearer than its ends say.
  void draw_line(ScreenPoint a, ScreenPoint b, double width, Colour colour, double raised);

  /// The samples of a row of pixels from the top, width() times `samples`.
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
