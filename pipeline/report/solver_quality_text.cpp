#include "pipeline/report/solver_quality_text.hpp"

#include "pipeline/report/places_json.hpp"

#include <array>
#include <string_view>

#include <fmt/format.h>

namespace aeroloom::report {
namespace {

constexpr std::array<std::string_view, mesh::face_class_count> class_titles = {
    "within layers", "at the front of layers", "off layers"};
constexpr std::array<std::string_view, mesh::solver_measure_count> measure_titles = {
    "non-orthogonality of faces, degrees", "skewness of faces", "aspect ratio of cells",
    "determinant of cells", "smaller / larger volume at a face"};

}  // namespace

std::vector<std::string> solver_lines(const mesh::SolverQuality& q) {
  return {
      fmt::format("non-orthogonality {:.4g} degrees at most, {:.4g} on average, {} of {} faces above 70; "
                  "skewness {:.4g} at most, {} faces above 4",
                  q.largest_non_orthogonality, q.average_non_orthogonality, q.non_orthogonal_faces,
                  q.inner_faces, q.largest_skewness, q.skewed_faces),
      fmt::format("aspect ratio {:.4g} at most, {} of {} cells above 1000; determinant {:.3g} at least, "
                  "{:.3g} on average; smaller / larger volume at a face {:.3g} at least, {:.3g} on average",
                  q.largest_aspect_ratio, q.stretched_cells, q.cells, q.smallest_determinant,
                  q.mean_determinant, q.smallest_volume_ratio, q.mean_volume_ratio)};
}

std::string solver_text(const mesh::SolverQuality& quality) {
  std::string text = "\nas cell-centred solvers judge\n";
  for (const std::string& line : solver_lines(quality)) text += line + "\n";
  text += fmt::format("{:<24}{:>13}{:>13}{:>11}{:>11}{:>14}{:>12}{:>12}\n", "inner faces", "faces",
                      "average deg", "max deg", "above 70", "volume ratio", "above 10", "above 30");
  for (const mesh::FaceClass face_class : mesh::all_face_classes) {
    const mesh::FacesOfClass& of = quality.faces_of(face_class);
    if (of.faces == 0) continue;
    text += fmt::format("{:<24}{:>13}{:>13.2f}{:>11.2f}{:>11}{:>14.4g}{:>12}{:>12}\n",
                        class_titles[static_cast<std::size_t>(face_class)], of.faces,
                        of.average_non_orthogonality, of.largest_non_orthogonality, of.non_orthogonal_faces,
                        of.largest_volume_ratio, of.high_volume_ratios, of.severe_volume_ratios);
  }
  return text;
}

std::string worst_text(const mesh::SolverQuality& quality) {
  std::string text = "\nworst as cell-centred solvers judge, with the middles of faces or cells\n";
  for (const mesh::SolverMeasure measure : mesh::all_solver_measures) {
    const std::vector<mesh::WorstCellOfShape>& worst = quality.worst_of(measure);
    if (worst.empty()) continue;
    text += fmt::format("{}\n", measure_titles[static_cast<std::size_t>(measure)]);
    text += list_of_worst(worst);
  }
  return text;
}

}  // namespace aeroloom::report
