/// The command `check`: diagnoses the geometry and predicts a run without meshing.
#pragma once

#include "cad/repair/diagnosis.hpp"
#include "parallel/communication/communicator.hpp"
#include "pipeline/case/case.hpp"
#include "pipeline/domain/level_findings.hpp"
#include "pipeline/domain/sizing_findings.hpp"
#include "pipeline/family_forecast.hpp"
#include "pipeline/layer_forecast.hpp"
#include "pipeline/level_forecast.hpp"
#include "pipeline/report/exit_code.hpp"
#include "pipeline/study/prediction_files.hpp"
#include "sizing/field/size_field.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace aeroloom::pipeline {

/// Two faces without common edge or vertex whose coarse facets meet. The faces intersect, or their distance
/// is below the accuracy of the facets.
struct FaceContact {
  cad::FaceId first, second;
  geometry::Vec3 where;  ///< where their facets meet first, in the order of facets
};

/// The predicted cost of a run (constants: docs/usage.md).
struct RunForecast {
  sizing::SizingOptions sizes;
  domain::SizingFindings findings;
  std::optional<LayerForecast> layers;               ///< if the case asks for layers; on rank 0
  double seconds = 0;                                ///< of one core, layers included
  double bytes = 0;                                  ///< of memory, all ranks together, layers included
  std::vector<LevelForecast> levels;                 ///< all levels of the same kind; empty without a level
  std::optional<domain::LevelFindings> found;        ///< by the level
  std::vector<FamilyLevel> family;                   ///< the levels asked for; on rank 0
  study::WorthwhileRanks worthwhile;                 ///< useful number of ranks
  std::int64_t piece_triangles = 0, piece_tets = 0;  ///< so that each rank gets several pieces
};

struct CheckRecord {
  cad::Diagnosis diagnosis;
  std::vector<FaceContact> contacts;  ///< at most 20
  std::int64_t contact_count = 0;
  std::vector<mesh::PatchType> patch_types;  ///< by patch of the model
  RunForecast forecast;
};

/// Contacts between faces outside the far field; lists at most `most`, counts all. Not collective.
std::vector<FaceContact> find_face_contacts(const cad::Model& model, std::size_t most, std::int64_t& count);

/// Diagnoses the geometry, prints the result on rank 0 and writes check.json (a warning if that fails).
/// Returns ok if a volume can be meshed, else cad. Collective. Throws CollectiveError if the geometry cannot
/// be read, std::invalid_argument for a patch rule that matches no face and for an impossible family.
report::ExitCode check_case(const parallel::Communicator& communicator, const cases::Case& input,
                            const FamilyRequest& family = {});

}  // namespace aeroloom::pipeline
