#include "pipeline/report/places_json.hpp"

#include "geometry/place_text.hpp"
#include "pipeline/report/change_json.hpp"

#include <fmt/format.h>

namespace aeroloom::report {

namespace {

mesh::WorstPlaces places_of(const VolumeFigures& figures) {
  if (figures.cells) return figures.cells->places;
  mesh::WorstPlaces places;
  std::vector<mesh::FlawedCell>& angles = places.of[static_cast<std::size_t>(mesh::Flaw::small_angle)];
  for (std::size_t i = 0; figures.quality && i < figures.quality->worst.size(); ++i) {
    const mesh::WorstCell& cell = figures.quality->worst[i];
    angles.push_back({cell.value, severity_of(mesh::Flaw::small_angle, cell.value), cell.cell,
                      mesh::CellShape::tetrahedron, mesh::Flaw::small_angle, cell.center});
  }
  if (figures.solver) mesh::add_faces(*figures.solver, places);
  mesh::list_worst_of_all(places);
  return places;
}

}  // namespace

std::vector<mesh::FlawedCell> worst_places(const VolumeFigures& figures) {
  return places_of(figures).all;
}

std::vector<mesh::FlawedCell> worst_flaws(const VolumeFigures& figures) {
  std::vector<mesh::FlawedCell> worst;
  for (const std::vector<mesh::FlawedCell>& of : places_of(figures).of)
    if (!of.empty()) worst.push_back(of.front());
  return worst;
}

std::string text_of_flaw(const mesh::FlawedCell& place) {
  switch (place.flaw) {
    case mesh::Flaw::small_angle:
      return fmt::format("an angle of {:.3g} degrees", place.value);
    case mesh::Flaw::bad_shape:
      return fmt::format("a shape of {:.2g}", place.value);
    case mesh::Flaw::non_orthogonality:
      return fmt::format("a face with a non-orthogonality of {:.3g} degrees", place.value);
    case mesh::Flaw::skewness:
      return fmt::format("a face with a skewness of {:.3g}", place.value);
    case mesh::Flaw::size_jump:
      break;
  }
  return fmt::format("a neighbour {:.0f} times as large", place.value);
}

std::string text_of_place(const mesh::FlawedCell& place) {
  return fmt::format("{} (cell {} of the {}, at {})", text_of_flaw(place), place.cell,
                     mesh::name_of(place.shape), geometry::place_text(place.center));
}

nlohmann::ordered_json to_json(const std::vector<mesh::FlawedCell>& places) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const mesh::FlawedCell& place : places) {
    json.push_back({{"flaw", mesh::name_of(place.flaw)},
                    {"value", place.value},
                    {"verdict", mesh::name_of(mesh::verdict_of(place.severity))},
                    {"shape", mesh::name_of(place.shape)},
                    {"cell", place.cell},
                    {"center", to_json(place.center)}});
  }
  return json;
}

nlohmann::ordered_json to_json(const std::vector<mesh::WorstCellOfShape>& worst) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const mesh::WorstCellOfShape& cell : worst) {
    json.push_back({{"value", cell.value},
                    {"shape", mesh::name_of(cell.shape)},
                    {"cell", cell.cell},
                    {"center", to_json(cell.center)}});
  }
  return json;
}

std::string list_of_worst(const std::vector<mesh::WorstCellOfShape>& worst) {
  std::string text;
  for (const mesh::WorstCellOfShape& cell : worst) {
    text += fmt::format("{:>14.6g}  {:<10} {:>13} at {}\n", cell.value, mesh::name_of(cell.shape), cell.cell,
                        geometry::place_text(cell.center));
  }
  return text;
}

}  // namespace aeroloom::report
