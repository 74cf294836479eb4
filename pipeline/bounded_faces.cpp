#include "pipeline/bounded_faces.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

constexpr std::size_t shown_faces = 4;
constexpr double least_fraction = 0.01;  // of a face's area, to be told in a line

std::string degrees_text(double degrees) {
  if (degrees >= 180) return "180 degrees and more";
  return degrees < 10 ? fmt::format("up to {:.2g} degrees", degrees) : fmt::format("up to {:.0f} degrees", degrees);
}

}  // namespace

std::vector<NamedBound> report_bounded_faces(const sizing::ModelSampler& sampler,
                                             const sizing::SizingOptions& sizes) {
  std::vector<NamedBound> faces;
  for (const sizing::BoundedFace& each : sampler.faces_bounded_by_minimum(sizes))
    faces.push_back({sampler.model().face(each.face).name, each.fraction, each.degrees});
  std::stable_sort(faces.begin(), faces.end(),
                   [](const NamedBound& a, const NamedBound& b) { return a.fraction > b.fraction; });
  return faces;
}

std::string describe(const std::vector<NamedBound>& faces, const sizing::SizingOptions& sizes) {
  std::string text;
  std::size_t told = 0, left_out = 0;
  for (const NamedBound& each : faces) {
    if (each.fraction < least_fraction) break;
    if (told == shown_faces) {
      ++left_out;
      continue;
    }
    text += fmt::format("{} on {:.0f} % of '{}' elements turn by {}", told++ > 0 ? "," : "",
                        100 * each.fraction, each.face, degrees_text(each.degrees));
  }
  if (text.empty()) return text;
  if (left_out > 0) text += fmt::format(", and on {} more", left_out);
  return fmt::format("the smallest size ({:.3g}) wins over {:.3g} degrees per element{}:{}", sizes.minimum,
                     sizes.curvature_angle, sizes.chordal_deviation > 0 ? " and the deviation asked for" : "",
                     text);
}

nlohmann::ordered_json to_json(const std::vector<NamedBound>& faces) {
  auto json = nlohmann::ordered_json::array();
  for (const NamedBound& each : faces)
    json.push_back({{"face", each.face}, {"fraction", each.fraction}, {"degrees", each.degrees}});
  return json;
}

}  // namespace aeroloom::pipeline
