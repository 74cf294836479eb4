#include "pipeline/domain/bounded_faces.hpp"

#include "sizing/choice/field_factory.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

namespace aeroloom::domain {
namespace {

constexpr std::size_t shown_faces = 4;   // in a line of the log; the report has all
constexpr double least_fraction = 0.01;  // of a face's area, to be named in a line
constexpr double half_turn = 180;        // degrees: an element that turns by it follows no curvature at all
constexpr double few_degrees = 10;       // below this, printed with a digit more
/// Two elements around a leading edge. Chosen, not measured.
constexpr double lost_shape = 90;
constexpr double much_of_body = 0.1;  // of its area; chosen, not measured

std::string degrees_text(double degrees) {
  if (degrees >= half_turn) return "180 degrees and more";
  return degrees < few_degrees ? fmt::format("up to {:.2g} degrees", degrees)
                               : fmt::format("up to {:.0f} degrees", degrees);
}

double body_fraction(const std::vector<NamedBound>& faces) {
  double sum = 0;
  for (const NamedBound& each : faces) sum += each.body_fraction;
  return sum;
}

}  // namespace

std::vector<NamedBound> report_bounded_faces(sizing::FieldFactory& factory,
                                             const sizing::SizingOptions& sizes) {
  const cad::Model& model = factory.model();
  std::map<std::string, NamedBound> by_name;
  for (const sizing::BoundedFace& each : factory.faces_bounded_by_minimum(sizes)) {
    NamedBound& bound = by_name[model.face(each.face).name];
    bound.body_fraction += each.fraction * factory.sampled().area(each.face);
    bound.degrees = std::max(bound.degrees, std::min(each.degrees, half_turn));
  }
  std::map<std::string, double> areas;
  double body = 0;
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    if (model.is_far_field(f)) continue;
    areas[model.face(f).name] += factory.sampled().area(f);
    body += factory.sampled().area(f);
  }
  std::vector<NamedBound> faces;
  for (auto& [name, bound] : by_name) {
    bound.face = name;
    bound.fraction = std::min(1.0, bound.body_fraction / areas[name]);
    bound.body_fraction /= body;
    faces.push_back(bound);
  }
  std::stable_sort(faces.begin(), faces.end(),
                   [](const NamedBound& a, const NamedBound& b) { return a.fraction > b.fraction; });
  return faces;
}

std::string describe(const std::vector<NamedBound>& faces, const sizing::SizingOptions& sizes) {
  std::string text;
  std::size_t named = 0, left_out = 0;
  for (const NamedBound& each : faces) {
    if (each.fraction < least_fraction) break;
    if (named == shown_faces) {
      ++left_out;
      continue;
    }
    text += fmt::format("{} on {:.0f} % of '{}' elements turn by {}", named++ > 0 ? "," : "",
                        100 * each.fraction, each.face, degrees_text(each.degrees));
  }
  if (text.empty()) return text;
  if (left_out > 0) text += fmt::format(", and on {} more", left_out);
  text = fmt::format("the smallest size ({:.3g}) wins over {:.3g} degrees per element{}:{}", sizes.minimum,
                     sizes.curvature_angle, sizes.chordal_deviation > 0 ? " and the deviation asked for" : "",
                     text);
  return text;
}

std::string warning_of(const std::vector<NamedBound>& faces, const sizing::SizingOptions& sizes) {
  const NamedBound* worst = nullptr;
  for (const NamedBound& each : faces) {
    if (each.fraction >= least_fraction && (worst == nullptr || each.degrees > worst->degrees)) worst = &each;
  }
  if (worst == nullptr || (worst->degrees < lost_shape && body_fraction(faces) <= much_of_body)) return {};
  return fmt::format(
      "elements turn by {}, most on '{}', for the smallest size ({:.3g}) wins over {:.3g} degrees per "
      "element "
      "on {:.3g} % of the body. Remedy: a smaller sizing.minimum (in the unit of the model), a larger "
      "sizing.target_tetrahedra where it is chosen, or a larger sizing.curvature_angle",
      degrees_text(worst->degrees), worst->face, sizes.minimum, sizes.curvature_angle,
      100 * body_fraction(faces));
}

}  // namespace aeroloom::domain
