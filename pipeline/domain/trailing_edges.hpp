/// The fate of blunt trailing edges: kept, closed or graded, decided after a trial sizing.
#pragma once

#include "cad/model/model.hpp"
#include "geometry/vec.hpp"
#include "sizing/field/size_field.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace aeroloom::sizing {
struct TrailingEdge;
}

namespace aeroloom::domain {

/// Elements along a strip that are longer than it is wide by more than this give angles below some 20
/// degrees.
inline constexpr double largest_kept_aspect = 2.7;
/// How far borders may move to be closed: of the local chord, and of the size that elements would have there.
inline constexpr double closing_share_of_chord = 4e-4, closing_share_of_size = 0.05;

enum class EdgeFate : std::uint8_t {
  kept,    ///< its elements are fit as they are
  closed,  ///< to a curve half-way between its borders
  graded,  ///< too wide to be closed unseen: elements along it are longer than that
};

/// A blunt trailing edge narrower than the smallest size.
struct JudgedEdge {
  cad::FaceId face = cad::no_entity;  ///< of the domain
  std::string name;
  geometry::Vec3 place;
  double length = 0, narrowest = 0, widest = 0;
  double chord = 0;   ///< the local chord, the shortest along it
  double share = 0;   ///< of the local chord that it is wide, at most
  double aspect = 1;  ///< of elements along it; of one that was closed, in the trial
  EdgeFate fate = EdgeFate::kept;
  std::string what = {};  ///< a sentence for people

  static constexpr auto fields() {
    return std::tuple(&JudgedEdge::face, &JudgedEdge::name, &JudgedEdge::place, &JudgedEdge::length,
                      &JudgedEdge::narrowest, &JudgedEdge::widest, &JudgedEdge::chord, &JudgedEdge::share,
                      &JudgedEdge::aspect, &JudgedEdge::fate, &JudgedEdge::what);
  }
};

using TrailingEdgeReport = std::vector<JudgedEdge>;

/// How far the borders of an edge move that is closed, at most.
double moved(const JudgedEdge& edge);
const char* name_of(EdgeFate fate);

/// The sizes of a trial, as far as trailing edges are judged by them.
struct TrialSizes {
  std::function<double(double)> aspect_at;  ///< of elements along a strip that is so wide
  double minimum;                           ///< of what is no feature
  /// At these places, did strips ask for nothing. Asked for where `minimum` does not tell enough; may be
  /// collective.
  std::function<std::vector<double>(const std::vector<geometry::Vec3>&)> sizes_without_strips;
};

/// Judges each. Collective where the trial's functions are.
TrailingEdgeReport judge_trailing_edges(const cad::Model& domain,
                                        const std::vector<sizing::TrailingEdge>& edges,
                                        const TrialSizes& trial);

/// The domain with what was judged to be closed; what cannot be is graded. Nothing where none is left to
/// close. The same on every rank; not collective.
std::optional<cad::Model> close_trailing_edges(const cad::Model& domain,
                                               const std::vector<sizing::TrailingEdge>& edges,
                                               TrailingEdgeReport& report);

/// Judges edges that were to be graded again, under the sizes that were chosen in the end: where others were
/// closed there is more for them.
void judge_again(TrailingEdgeReport& report, const sizing::SizingOptions& sizes);

/// The domain with the edges closed that a report has as closed; it is that domain's. Throws cad::CadError.
cad::Model close_again(const cad::Model& domain, const TrailingEdgeReport& report);

bool has_closed(const TrailingEdgeReport& report);

/// Base drag that a blunt end has and a sharp one lacks, in counts (1e-4) of the section's drag by its chord:
/// 0.135 (h/c)^(4/3) / cd^(1/3) with cd = 0.006 for the section without it. S. F. Hoerner, Fluid-Dynamic
/// Drag, 1965, chapter 3.
double base_drag_counts(double width_over_chord);

}  // namespace aeroloom::domain
