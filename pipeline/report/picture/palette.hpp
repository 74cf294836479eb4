/// Reduces an image to few colours, for files with a palette.
#pragma once

#include "pipeline/report/picture/image.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::picture {

/// An image whose pixels are indices into a palette.
struct PalettedImage {
  std::vector<Colour> palette;       ///< at most 256
  std::vector<std::uint8_t> pixels;  ///< by rows from the top
};

/// The image in at most `most` colours (2 to 256), by median cut: the box of colours is divided repeatedly
/// where the spread is largest (Heckbert, SIGGRAPH 1982, doi:10.1145/800064.801294). Colours within 8 of 256
/// steps count as equal.
PalettedImage quantise(const Image& image, int most);

}  // namespace aeroloom::picture
