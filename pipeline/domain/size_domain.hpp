/// Chooses sizes for a domain as the case asks, and simplifies the model for them.
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

/// Allowed changes to the model that avoid very small elements.
struct Simplification {
  cases::NarrowFaces narrow_faces = cases::NarrowFaces::join;
  cad::TrailingEdges trailing_edges = cad::TrailingEdges::keep;  ///< `sharpen` happens earlier, in the CAD

  static Simplification of(const cases::Case& input) {
    return {input.narrow_faces, input.domain.trailing_edges.treatment};
  }
};

struct SizedDomain {
  cad::Model model;  ///< after closing trailing edges and joining narrow faces
  sizing::SizingOptions sizes;
  sizing::SizeField field;
  SizingFindings findings;
  std::optional<sizing::Level> level = {};  ///< the level of these sizes
  std::optional<LevelFindings> found = {};  ///< by the level
};

/// Chooses all sizes that the user left open, within the bounds that the user gave. Closes blunt trailing
/// edges that trial sizes do not resolve if that moves little, joins narrow faces, and builds the size field.
/// All of this is as at scale 1; then sizes, field and counts are those of the request's scale. Field and
/// counts may be approximate for a forecast. Equal on every rank. Collective. Throws std::invalid_argument
/// for contradicting requests.
SizedDomain size_domain(const parallel::Communicator& communicator, const cad::Model& model,
                        const cases::SizingRequest& request, const Simplification& simplification,
                        sizing::FieldFor purpose = sizing::FieldFor::mesh);

/// Throws CollectiveError (input), with the faces, if faces lie on one another. Equal on every rank.
void require_walls_apart(const SizedDomain& sized);

}  // namespace aeroloom::domain
