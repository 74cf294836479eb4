#include "pipeline/report/solver_quality_json.hpp"

#include "pipeline/report/places_json.hpp"

#include <string>

namespace aeroloom::report {
namespace {

using Json = nlohmann::ordered_json;

Json class_json(const mesh::FacesOfClass& of) {
  return {{"faces", of.faces},
          {"average_deg", of.average_non_orthogonality},
          {"largest_deg", of.largest_non_orthogonality},
          {"above_70_deg", of.non_orthogonal_faces},
          {"largest_volume_ratio", of.largest_volume_ratio},
          {"volume_ratio_above_10", of.high_volume_ratios},
          {"volume_ratio_above_30", of.severe_volume_ratios}};
}

}  // namespace

Json to_json(const mesh::SolverQuality& quality) {
  Json json = {
      {"inner_faces", quality.inner_faces},
      {"boundary_faces", quality.boundary_faces},
      {"non_orthogonality",
       {{"average_deg", quality.average_non_orthogonality},
        {"largest_deg", quality.largest_non_orthogonality},
        {"above_70_deg", quality.non_orthogonal_faces}}},
      {"skewness", {{"largest", quality.largest_skewness}, {"above_4", quality.skewed_faces}}},
      {"aspect_ratio", {{"largest", quality.largest_aspect_ratio}, {"above_1000", quality.stretched_cells}}},
      {"determinant",
       {{"smallest", quality.smallest_determinant},
        {"mean", quality.mean_determinant},
        {"below_0.001", quality.underdetermined_cells}}},
      {"volume_ratio", {{"smallest", quality.smallest_volume_ratio}, {"mean", quality.mean_volume_ratio}}}};
  for (const mesh::FaceClass face_class : mesh::all_face_classes)
    json["faces"][std::string(name_of(face_class))] = class_json(quality.faces_of(face_class));
  for (const mesh::SolverMeasure measure : mesh::all_solver_measures)
    json["worst"][std::string(name_of(measure))] = to_json(quality.worst_of(measure));
  return json;
}

}  // namespace aeroloom::report
