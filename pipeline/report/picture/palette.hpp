/// Few colours for many: what a file with a palette needs.
#pragma once

#include "pipeline/report/picture/image.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::picture {

/// An image whose pixels name colours of a list.
struct PalettedImage {
  std::vector<Colour> palette;       ///< 256 at most
  std::vector<std::uint8_t> pixels;  ///< row by row from the top
};

/// The image in at most that many colours, found by dividing the box of all colours again and again where
/// their spread is largest (Heckbert, SIGGRAPH 1982, doi:10.1145/800064.801294). Colours nearer to each other
/// than 8 of 256 steps count as one. `most` from 2 to 256.
PalettedImage quantise(const Image& image, int most);

}  // namespace aeroloom::picture
