#include "layers/side_layers.hpp"

#include "layers/layer_report.hpp"
#include "layers/opened_wall.hpp"

#include <cstddef>

namespace aeroloom::layers {
namespace {

bool wants(const LayerOptions& options, std::size_t patch, InnerSides side) {
  if (patch >= options.patches.size()) return false;
  const InnerSides asked = inner_sides_of(options, patch);
  return options.patches[patch].first > 0 && (asked == side || asked == InnerSides::both);
}

}  // namespace

bool has_inner_layers(const mesh::DistributedMesh& wall, const LayerOptions& options) {
  bool found = false;
  for (const mesh::Piece& piece : wall.pieces) {
    if (!wall.sides_of(piece.common_face()).is_inner()) continue;
    for (const std::int32_t patch : piece.triangle_patch) {
      const auto p = static_cast<std::size_t>(patch);
      found = found || wants(options, p, InnerSides::front) || wants(options, p, InnerSides::back);
    }
  }
  return wall.communicator.maximum(std::int64_t{found}) > 0;
}

LayerOptions options_of_sides(const OpenedWall& opened, const LayerOptions& options) {
  LayerOptions of_sides = options;
  const std::size_t count = opened.before.patches.size();
  of_sides.patches.resize(3 * count);
  for (std::size_t p = 0; p < count && p < options.patches.size(); ++p) {
    if (wants(options, p, InnerSides::front)) of_sides.patches[count + 2 * p] = options.patches[p];
    if (wants(options, p, InnerSides::back)) of_sides.patches[count + 2 * p + 1] = options.patches[p];
  }
  return of_sides;
}

std::vector<PatchLayers> join_sides(const OpenedWall& opened, const std::vector<PatchLayers>& patches) {
  const std::size_t count = opened.before.patches.size();
  std::vector<PatchLayers> joined(patches.begin(), patches.begin() + static_cast<std::ptrdiff_t>(count));
  for (std::size_t p = 0; p < count; ++p) {
    for (std::size_t side = 0; side < 2; ++side) add_figures(patches[count + 2 * p + side], joined[p]);
  }
  return joined;
}

}  // namespace aeroloom::layers
