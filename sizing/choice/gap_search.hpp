/// Gaps between the faces of a model, looked for once, before any sizes.
#pragma once

#include "sizing/choice/sampled_model.hpp"

#include <limits>
#include <map>
#include <tuple>
#include <vector>

namespace aeroloom::sizing {

/// A face on which the search for gaps ended early.
struct UnseenGaps {
  cad::FaceId face;
  geometry::Vec3 place;  ///< middle of the largest part that was not looked at
  double size;           ///< of that part: gaps much narrower than this may have been missed there

  static constexpr auto fields() {
    return std::tuple(&UnseenGaps::face, &UnseenGaps::place, &UnseenGaps::size);
  }
};

/// The gaps that all faces of a model see, each searched by the rank that samples it.
class GapSearch {
public:
  /// `layers`: elements across a gap that fields may ask for, at most; 0: no gaps are looked for. Collective.
  GapSearch(const SampledModel& sampled, double layers);

  /// For the model with some faces joined: gaps of all faces that have no joined neighbour are taken over.
  /// Collective.
  GapSearch(GapSearch&& before, const SampledModel& joined);

  /// Those seen from a face of this rank; null where none were looked for.
  const Gaps* of_face(cad::FaceId face) const {
    const auto known = _gaps.find(face);
    return known == _gaps.end() ? nullptr : &known->second;
  }
  /// The width of the narrowest gap that sizes below the minimum resolve; infinite where there is none, or
  /// none were looked for. The same on every rank.
  double narrowest_gap() const { return _narrowest_gap; }
  /// Faces on which the search for gaps ended early, for the work it would have been; in the order of faces,
  /// the same on every rank.
  const std::vector<UnseenGaps>& unseen_gaps() const { return _unseen_gaps; }

private:
  enum class Notes { tell, were_told };
  void measure(const SampledModel& sampled, Notes notes);
  /// What all ranks have found. Collective.
  void gather(const SampledModel& sampled);

  double _layers;
  std::map<cad::FaceId, Gaps> _gaps;
  std::vector<UnseenGaps> _unseen_gaps;
  double _narrowest_gap = std::numeric_limits<double>::infinity();
};

}  // namespace aeroloom::sizing
