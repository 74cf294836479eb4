/// From a domain and what a case says about sizes to the model and the sizes of a run.
#pragma once

#include "cad/model/model.hpp"
#include "parallel/communication/communicator.hpp"
#include "pipeline/case/case.hpp"
#include "pipeline/domain/level_findings.hpp"
#include "pipeline/domain/sizing_findings.hpp"
#include "sizing/choice/given_sizes.hpp"
#include "sizing/choice/levels.hpp"
#include "sizing/field/size_field.hpp"

#include <optional>

namespace aeroloom::domain {

/// Simplifications that a model may undergo so that it needs no small elements.
struct Simplification {
  cases::NarrowFaces narrow_faces = cases::NarrowFaces::join;
  cad::TrailingEdges trailing_edges = cad::TrailingEdges::keep;  ///< `sharpen` was done to the model before

  static Simplification of(const cases::Case& input) {
    return {input.narrow_faces, input.domain.trailing_edges.treatment};
  }
};

struct SizedDomain {
  cad::Model model;  ///< trailing edges closed, then faces narrower than the smallest size joined with
                     ///< neighbours, if wanted
  sizing::SizingOptions sizes;
  sizing::SizeField field;
  SizingFindings findings;
  std::optional<sizing::Level> level = {};  ///< whose sizes these are
  std::optional<LevelFindings> found = {};  ///< by that level
};

/// Resolves sizes, closes trailing edges that trial sizes do not resolve where that moves little, joins
/// narrow faces, as the simplification allows, and builds the field. What the user did not
/// ask for is chosen from the model; bounds that the user gave bind the choice. The same on every rank.
/// Collective. Throws std::invalid_argument where what was asked for contradicts what was chosen.
/// Field and counts may be rough where the purpose is a forecast.
SizedDomain size_domain(const parallel::Communicator& communicator, const cad::Model& model,
                        const cases::SizingRequest& request, const Simplification& simplification,
                        sizing::FieldFor purpose = sizing::FieldFor::mesh);

/// Ends a run whose faces lie on one another: CollectiveError (input), with the faces. The same on every
/// rank.
void require_walls_apart(const SizedDomain& sized);

}  // namespace aeroloom::domain
