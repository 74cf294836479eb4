#include "cad/model/evaluation/face_width.hpp"

#include <cmath>
#include <ranges>

namespace aeroloom::cad {

double rough_length(const Model& model, EdgeId id) {
  constexpr int intervals = 16;  // a chord over a sixteenth of a circle is short by 0.6 %: rough enough
  const Edge& edge = model.edge(id);
  if (edge.degenerate) return 0;
  double length = 0;
  Vec3 last = model.edge_point(id, edge.first_parameter);
  for (int i = 1; i <= intervals; ++i) {
    const double along = static_cast<double>(i) / intervals;
    const Vec3 next =
        model.edge_point(id, edge.first_parameter + along * (edge.last_parameter - edge.first_parameter));
    length += distance(last, next);
    last = next;
  }
  return length;
}

double mean_width(const Model& model, FaceId face) {
  double perimeter = 0;
  for (const Coedge& use : model.face(face).loops | std::views::join) {
    if (!model.is_seam(use.edge)) perimeter += rough_length(model, use.edge);
  }
  const double area = model.face_area(face);
  return perimeter > 0 ? 2 * area / perimeter : std::sqrt(area);
}

}  // namespace aeroloom::cad
