#include "pipeline/domain/wall_findings.hpp"

#include "cad/tolerances.hpp"
#include "geometry/place_text.hpp"
#include "sizing/choice/coincident_faces.hpp"
#include "sizing/choice/field_factory.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace aeroloom::domain {
namespace {

constexpr std::size_t shown_walls = 5;
/// Elements over the distance between two faces, from which on these are one to them: the same five times
/// that let faces be near (docs/bounds.md).
constexpr double size_over_distance = 5;
/// Distance over the length of the place where two faces are on one another, below which it is rounding.
constexpr double exact = cad::tolerances::rounding;

std::string and_more(std::size_t all) {
  return all > shown_walls ? fmt::format("; and {} more", all - shown_walls) : "";
}

std::string describe(const FacesOnOneAnother& each) {
  const std::string place =
      fmt::format("over an area of about {:.3g} near {}", each.area, geometry::place_text(each.place));
  if (each.triangles > 0) {
    return fmt::format(
        "faces '{}' and '{}' lie on one another but for a gap of {:.2g} at most, {}, where elements as small "
        "would be about {:.2g} triangles on each",
        each.first, each.second, each.apart, place, each.triangles);
  }
  return fmt::format("faces '{}' and '{}' lie on one another {}, {}", each.first, each.second, place,
                     each.apart > exact * std::sqrt(each.area)
                         ? fmt::format("{:.2g} apart at most", each.apart)
                         : "exactly");
}

}  // namespace

WallFindings report_walls(const cad::Model& model, const std::vector<sizing::CoincidentFaces>& coincident,
                          const sizing::FieldFactory& factory, const sizing::SizeField& field) {
  WallFindings walls;
  for (const sizing::UnseenGaps& each : factory.gaps().unseen_gaps())
    walls.unseen.push_back({factory.model().face(each.face).name, each.place, each.size});
  for (const sizing::CoincidentFaces& each : coincident) {
    if (field(each.place) < size_over_distance * each.apart) continue;
    walls.coincident.push_back({model.face(each.first).name, model.face(each.second).name, each.area,
                                each.place, each.apart, each.triangles});
  }
  return walls;
}

std::string describe(const std::vector<UnseenWalls>& unseen) {
  if (unseen.empty()) return {};
  return fmt::format(
      "the search for gaps ended early on {} face(s), as on '{}' near {} for {:.3g} around: narrow gaps may "
      "have been missed. Remedy: smaller sizes there (sizing.surface_maximum)",
      unseen.size(), unseen.front().face, geometry::place_text(unseen.front().place), unseen.front().size);
}

std::string describe(const std::vector<FacesOnOneAnother>& coincident) {
  if (coincident.empty()) return {};
  std::string text;
  bool any_void = false, any_gap = false;
  for (std::size_t i = 0; i < coincident.size(); ++i) {
    const FacesOnOneAnother& each = coincident[i];
    (each.triangles > 0 ? any_gap : any_void) = true;
    if (i < shown_walls) text += (i == 0 ? "" : "; ") + describe(each);
  }
  text += and_more(coincident.size());
  if (any_void) {
    text +=
        ". There is no volume between them to mesh. Remedy: remove one of them in the CAD program, or unite "
        "the parts they belong to";
  }
  if (any_gap) {
    text += fmt::format(
        ". {} too thin for a mesh. Remedy: close or widen {} in the CAD program, or ask for sizes there of "
        "at "
        "most {} times the gap",
        any_void ? "Gaps are" : "The gap is", any_void ? "them" : "it", size_over_distance);
  }
  return text;
}

}  // namespace aeroloom::domain
