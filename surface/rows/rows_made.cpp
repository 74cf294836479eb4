#include "surface/rows/rows_made.hpp"

#include "surface/rows/edge_rows.hpp"

#include <algorithm>

namespace aeroloom::surface {
namespace {

/// Whether a face has rows along an edge: as find_face_rows().
bool may_have_rows(const cad::Model& model, cad::EdgeId edge) {
  const std::vector<cad::FaceId>& faces = model.edge(edge).faces;
  return is_constraining(model, edge) &&
         std::any_of(faces.begin(), faces.end(), [&](cad::FaceId face) { return !model.is_faceted(face); });
}

RowsMade measure(std::span<const geometry::Vec3> vertices, const EdgeRows& rows, bool may_have) {
  constexpr double least_stretch = 4;
  RowsMade made;
  made.height = rows.height;
  const std::vector<int> counts = count_rows(vertices, rows);
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    const double segment = distance(vertices[i - 1], vertices[i]);
    const int most = std::max(counts[i - 1], counts[i]);
    made.length += segment;
    if (!may_have || most == 0) continue;
    made.with_rows += segment;
    if (segment >= least_stretch * rows.height) made.stretched += segment;
    made.longest = std::max(made.longest, segment);
    made.most = std::max(made.most, most);
  }
  return made;
}

}  // namespace

std::vector<RowsMade> list_rows(const cad::Model& model, const CurveMesh& curves,
                                std::span<const EdgeRows> rows) {
  std::vector<RowsMade> all;
  std::vector<geometry::Vec3> vertices;
  for (std::size_t e = 0; e < rows.size(); ++e) {
    if (!(rows[e].height > 0)) continue;
    const auto edge = static_cast<cad::EdgeId>(e);
    vertices.clear();
    for (const CurveVertex v : curves.chain(model, edge)) vertices.push_back(curves.points[v]);
    all.push_back(measure(vertices, rows[e], may_have_rows(model, edge)));
    all.back().edge = edge;
  }
  return all;
}

}  // namespace aeroloom::surface
