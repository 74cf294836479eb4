/// Combines the canvases of all ranks into one PNG image.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "pipeline/report/picture/canvas.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace aeroloom::picture {

/// Colours by rows from the top.
struct Image {
  int width = 0, height = 0;
  std::vector<Colour> pixels;
};

/// The drawings of all ranks, nearest in front, on rank 0; empty elsewhere. Each rank combines one band of
/// the image (direct send; Hsu, Parallel Rendering Symposium, 1993). Empty samples are not sent. The image
/// does not depend on the distribution of the mesh. `draw_alike` draws what all ranks would draw equally,
/// after the exchange. Canvases have equal size. Collective.
Image composite(const parallel::Communicator& communicator, Canvas canvas, Colour background,
                const std::function<void(Canvas&)>& draw_alike = nullptr);

/// The image as PNG with a palette: the most colours, 16 to 256, that keep it below `bytes`. Throws
/// std::runtime_error.
std::vector<std::uint8_t> encode_png(const Image& image, std::size_t bytes);

}  // namespace aeroloom::picture
