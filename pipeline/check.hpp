/// The command check: what a run would meet, before it meshes anything.
#pragma once

#include "cad/repair/diagnosis.hpp"
#include "parallel/communication/communicator.hpp"
#include "pipeline/case/case.hpp"
#include "pipeline/domain/level_findings.hpp"
#include "pipeline/domain/sizing_findings.hpp"
#include "pipeline/layer_forecast.hpp"
#include "pipeline/level_forecast.hpp"
#include "pipeline/report/exit_code.hpp"
#include "pipeline/study/prediction_files.hpp"
#include "sizing/field/size_field.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace aeroloom::pipeline {

/// Two faces whose coarse facets meet although the faces share no edge and no vertex: they intersect, or are
/// closer to each other than the facets follow them.
struct FaceContact {
  cad::FaceId first, second;
  geometry::Vec3 where;
};

/// The predicted cost of a run, by the constants in docs/usage.md.
struct RunForecast {
  sizing::SizingOptions sizes;
  domain::SizingFindings findings;
  std::optional<LayerForecast> layers;               ///< where the case asks for them; on rank 0
  double seconds = 0;                                ///< of one core, with layers
  double bytes = 0;                                  ///< of memory, all ranks together, with layers
  std::vector<LevelForecast> levels;                 ///< all of those of the case's level; none without
  std::optional<domain::LevelFindings> found;        ///< by that level
  study::WorthwhileRanks worthwhile;                 ///< how many ranks are worth asking for
  std::int64_t piece_triangles = 0, piece_tets = 0;  ///< piece sizes that give every rank several pieces
};

struct CheckRecord {
  cad::Diagnosis diagnosis;
  std::vector<FaceContact> contacts;  ///< at most 20
  std::int64_t contact_count = 0;
  std::vector<mesh::PatchType> patch_types;  ///< by patch of the model
  RunForecast forecast;
};

/// Contacts among the faces of a model that are not far field, at most `most` of them listed. Not collective.
std::vector<FaceContact> find_face_contacts(const cad::Model& model, std::size_t most, std::int64_t& count);

/// Diagnoses the geometry, prints what was found on rank 0 and writes check.json to the output directory.
/// Returns ok when a volume can be meshed, cad when not. Collective; throws CollectiveError when the file
/// cannot be read or check.json cannot be written, std::invalid_argument for a patch of the case that matches
/// no face.
report::ExitCode check_case(const parallel::Communicator& communicator, const cases::Case& input);

}  // namespace aeroloom::pipeline
