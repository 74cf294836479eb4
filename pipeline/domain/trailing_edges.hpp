/// Decides after a trial sizing whether blunt trailing edges are kept, closed or graded.
#pragma once

#include "cad/model/model.hpp"
#include "geometry/vec.hpp"
#include "sizing/field/size_field.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace aeroloom::sizing {
struct TrailingEdge;
}

namespace aeroloom::domain {

/// Largest ratio of length to width of elements along a blunt edge; above, angles fall below about 20
/// degrees.
inline constexpr double largest_kept_aspect = 2.7;
/// Largest displacement for closing an edge, over the local chord and over the local element size.
inline constexpr double closing_fraction_of_chord = 4e-4, closing_fraction_of_size = 0.05;

enum class EdgeFate : std::uint8_t {
  kept,    ///< sizes resolve its width
  closed,  ///< its borders meet in a curve half-way
  graded,  ///< too wide to close: elements are longer than wide
};

/// A blunt trailing edge narrower than the smallest size.
struct JudgedEdge {
  cad::FaceId face = cad::no_entity;  ///< of the domain
  std::string name;
  geometry::Vec3 place;
  double length = 0, narrowest = 0, widest = 0;
  double chord = 0;             ///< shortest local chord
  double width_over_chord = 0;  ///< largest ratio of width to local chord
  double aspect = 1;            ///< length over width of its elements; of a closed edge: in the trial
  EdgeFate fate = EdgeFate::kept;
  std::string what = {};  ///< one sentence for messages
};

using TrailingEdgeReport = std::vector<JudgedEdge>;

/// Largest displacement of the borders of a closed edge.
double moved(const JudgedEdge& edge);
const char* name_of(EdgeFate fate);

/// The trial sizes by which trailing edges are judged.
struct TrialSizes {
  std::function<double(double)> aspect_at;  ///< length over width of elements on a narrow face of this width
  double minimum;                           ///< smallest size without features
  /// Sizes at these points without narrow faces. Needed where `minimum` does not decide; may be collective.
  std::function<std::vector<double>(const std::vector<geometry::Vec3>&)> sizes_without_strips;
};

/// Decides on each edge. Collective if the functions of the trial are.
TrailingEdgeReport judge_trailing_edges(const cad::Model& domain,
                                        const std::vector<sizing::TrailingEdge>& edges,
                                        const TrialSizes& trial);

/// Closes the edges judged as closed; an edge that cannot be closed becomes graded. Empty if none is closed.
/// Equal on every rank; not collective.
std::optional<cad::Model> close_trailing_edges(const cad::Model& domain,
                                               const std::vector<sizing::TrailingEdge>& edges,
                                               TrailingEdgeReport& report);

/// Judges graded edges again by the final sizes: closing others has left more elements for them.
void judge_again(TrailingEdgeReport& report, const sizing::SizingOptions& sizes);

/// Closes in the same domain the edges that a report lists as closed. Throws cad::CadError.
cad::Model close_again(const cad::Model& domain, const TrailingEdgeReport& report);

bool has_closed(const TrailingEdgeReport& report);

/// Base drag of a blunt trailing edge in counts (1e-4), by the chord: 0.135 (h/c)^(4/3) / cd^(1/3) with cd =
/// 0.006 for the sharp section. S. F. Hoerner, Fluid-Dynamic Drag, 1965, chapter 3.
double base_drag_counts(double width_over_chord);

}  // namespace aeroloom::domain
