#include "io/medit/local_medit_mesh.hpp"

#include <algorithm>
#include <utility>

namespace aeroloom::io {

namespace {

/// Cells of volume of other shapes, or curved. Curved faces are left out like edges.
constexpr std::array<std::pair<std::int32_t, const char*>, 13> unreadable = {{{30, "TetrahedraP2"},
                                                                              {33, "HexahedraQ2"},
                                                                              {46, "Polyhedra"},
                                                                              {86, "PrismsP2"},
                                                                              {87, "PyramidsP2"},
                                                                              {96, "TetrahedraP3"},
                                                                              {97, "TetrahedraP4"},
                                                                              {98, "HexahedraQ3"},
                                                                              {99, "HexahedraQ4"},
                                                                              {100, "PyramidsP3"},
                                                                              {101, "PyramidsP4"},
                                                                              {102, "PrismsP3"},
                                                                              {103, "PrismsP4"}}};

}  // namespace

MeditItems* LocalMeditMesh::items(std::int32_t keyword) {
  for (std::size_t s = 0; s < medit_cells.size(); ++s) {
    if (static_cast<std::int32_t>(medit_cells[s]) == keyword) return &cells[s];
  }
  for (std::size_t s = 0; s < medit_faces.size(); ++s) {
    if (static_cast<std::int32_t>(medit_faces[s]) == keyword) return &faces[s];
  }
  return nullptr;
}

int medit_corners(std::int32_t keyword) {
  for (const CellShape shape : cell_shapes) {
    if (static_cast<std::int32_t>(medit_cells[static_cast<std::size_t>(shape)]) == keyword)
      return corners_of(shape);
  }
  for (const FaceShape shape : face_shapes) {
    if (static_cast<std::int32_t>(medit_faces[static_cast<std::size_t>(shape)]) == keyword)
      return corners_of(shape);
  }
  return 0;
}

std::string medit_unreadable(std::int32_t keyword) {
  const auto found = std::find_if(unreadable.begin(), unreadable.end(),
                                  [&](const auto& entry) { return entry.first == keyword; });
  return found == unreadable.end() ? "" : found->second;
}

bool medit_unreadable(const std::string& keyword) {
  return std::any_of(unreadable.begin(), unreadable.end(),
                     [&](const auto& entry) { return keyword == entry.second; });
}

}  // namespace aeroloom::io
