/// Searches the gaps between the faces of a model. The search is done once, before any sizes are known.
#pragma once

#include "sizing/choice/sampled_model.hpp"

#include <limits>
#include <map>
#include <vector>

namespace aeroloom::sizing {

/// What the fields of a model may ask of gaps.
struct GapDemand {
  double layers;               ///< the most elements across a gap; with 0 no gaps are looked for
  bool thin_by_width = false;  ///< and across thin parts of bodies
};
/// That of fields with these options.
GapDemand gap_demand(const SizingOptions& options);

/// A face on which the search for gaps ended early, to bound its cost.
struct UnseenGaps {
  cad::FaceId face;
  geometry::Vec3 place;  ///< middle of the largest part that was not searched
  double size;           ///< of that part; much narrower gaps may have been missed
};

/// The gaps seen from each face. A face is searched by the rank that samples it.
class GapSearch {
public:
  /// Collective.
  GapSearch(const SampledModel& sampled, GapDemand demand);

  /// For the model with some faces joined. Keeps the gaps of all faces without a joined neighbour.
  /// Collective.
  GapSearch(GapSearch&& before, const SampledModel& joined);

  /// The gaps seen from a face of this rank; null if none were looked for.
  const Gaps* of_face(cad::FaceId face) const {
    const auto known = _gaps.find(face);
    return known == _gaps.end() ? nullptr : &known->second;
  }
  /// The width of the narrowest gap that sizes below the minimum can resolve. Infinite if there is none. The
  /// same on every rank.
  double narrowest_gap() const { return _narrowest_gap; }
  /// The faces on which the search ended early, in the order of faces; the same on every rank.
  const std::vector<UnseenGaps>& unseen_gaps() const { return _unseen_gaps; }

private:
  enum class Notes { log, none };
  void measure(const SampledModel& sampled, Notes notes);
  /// Gathers the findings of all ranks. Collective.
  void gather(const SampledModel& sampled);

  GapDemand _demand;
  std::map<cad::FaceId, Gaps> _gaps;
  std::vector<UnseenGaps> _unseen_gaps;
  double _narrowest_gap = std::numeric_limits<double>::infinity();
};

}  // namespace aeroloom::sizing
