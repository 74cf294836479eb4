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

#include <functional>
#include <optional>
#include <vector>

namespace aeroloom::domain {

/// Allowed changes to the model that avoid very small elements.
struct Simplification {
  cases::NarrowFaces narrow_faces = cases::NarrowFaces::join;
  cad::TrailingEdges trailing_edges = cad::TrailingEdges::keep;  ///< `sharpen` happens earlier, in the CAD

  static Simplification of(const cases::Case& input) {
    return {input.narrow_faces, input.domain.trailing_edges.treatment};
  }
};

/// What surfaces of earlier sizes have shown (size_again()).
struct Experience {
  std::vector<sizing::SizeSource> places = {};  ///< where sizes fell; each rank has all
  double at_places = 0;                         ///< tetrahedra that fields predict for these
  double bias = 1;                              ///< tetrahedra that are made over those that fields predict
};

struct SizedDomain {
  cad::Model model;  ///< after closing trailing edges and joining narrow faces
  sizing::SizingOptions sizes;
  sizing::SizeField field;
  SizingFindings findings;
  std::optional<sizing::Level> level = {};  ///< the level of these sizes
  std::optional<LevelFindings> found = {};  ///< by the level
  double on_top = 0;                        ///< predicted tetrahedra that a target does not count
  Experience seen = {};                     ///< that led to these sizes
};

/// Chooses all sizes that the user left open, within the bounds that the user gave. Closes blunt trailing
/// edges that trial sizes do not resolve if that moves little, joins narrow faces, and builds the size field.
/// All of this is as at scale 1; then sizes, field and counts are those of the request's scale. Field and
/// counts may be approximate for a forecast. Equal on every rank. Collective. Throws std::invalid_argument
/// for contradicting requests.
SizedDomain size_domain(const parallel::Communicator& communicator, const cad::Model& model,
                        const cases::SizingRequest& request, const Simplification& simplification,
                        sizing::FieldFor purpose = sizing::FieldFor::mesh);

/// The outcome of the surface stage.
struct MadeSurface {
  const sizing::SizeField& field;                 ///< after rounds in which sizes fell
  const std::vector<sizing::SizeSource>& places;  ///< where, the same on every rank
  /// The tetrahedra that are to be made inside this surface; nothing if that cannot be told. Collective.
  std::function<std::optional<double>()> count;
};

/// Chooses sizes once more for the model of `sized` where far more or fewer tetrahedra are to be made than
/// the target asks for: for rounds of the surface stage let sizes fall, or as forecasts err. Everything else
/// gets so much coarser or finer that the target is met, as far as two fifths of it are left for that.
/// Nothing where the sizes stay: they were given, or are of a scale or a level, or the count is as asked.
/// Collective.
std::optional<SizedDomain> size_again(const SizedDomain& sized, const cases::SizingRequest& request,
                                      const MadeSurface& made);

/// Whether `count` tetrahedra are nearer to the target than `other`.
bool comes_nearer(double count, double other, const SizedDomain& sized, const cases::SizingRequest& request);
/// Notes among the findings where so many tetrahedra are to be made that the target is missed by far.
void note_count(SizedDomain& sized, const cases::SizingRequest& request, double count);

/// Throws CollectiveError (input), with the faces, if faces lie on one another. Equal on every rank.
void require_walls_apart(const SizedDomain& sized);

}  // namespace aeroloom::domain
