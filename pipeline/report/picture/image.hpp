/// From the canvases of all ranks to one picture in a file's bytes.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "pipeline/report/picture/canvas.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace aeroloom::picture {

/// Colours row by row from the top.
struct Image {
  int width = 0, height = 0;
  std::vector<Colour> pixels;
};

/// The drawings of all ranks, the nearest in front, on rank 0; empty elsewhere. Each rank puts a strip
/// together (Hsu, Parallel Rendering Symposium, 1993: direct send); what is empty does not travel. The same
/// for any distribution of what is drawn. `draw_alike` draws what every rank would draw alike, and does not
/// travel. Collective; canvases are of one size.
Image composite(const parallel::Communicator& communicator, Canvas canvas, Colour background,
                const std::function<void(Canvas&)>& draw_alike = nullptr);

/// The image as PNG, with a palette: as many colours, at most 256, as keep it below `bytes`, but 16 at least.
/// Throws std::runtime_error.
std::vector<std::uint8_t> encode_png(const Image& image, std::size_t bytes);

}  // namespace aeroloom::picture
