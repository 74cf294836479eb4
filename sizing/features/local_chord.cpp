#include "sizing/features/local_chord.hpp"

#include "sizing/features/segment_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace aeroloom::sizing {
namespace {

using geometry::Vec3;

/// A plane through the place, and the direction in it that leads into the body.
struct SectionPlane {
  Vec3 origin, normal, forward;
};

/// A part of a section between two places ahead of the edge.
struct Piece {
  double first, last;  ///< ahead, first <= last
  Vec3 end;            ///< the point farther ahead
};

std::optional<Piece> cut(const Triangle& t, const SectionPlane& plane) {
  double away[3];
  for (int i = 0; i < 3; ++i) away[i] = dot(t[i] - plane.origin, plane.normal);
  std::optional<Piece> piece;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if ((away[i] >= 0) == (away[j] >= 0)) continue;
    const Vec3 point = t[i] + away[i] / (away[i] - away[j]) * (t[j] - t[i]);
    const double ahead = dot(point - plane.origin, plane.forward);
    if (!piece) {
      piece = {ahead, ahead, point};
    } else {
      if (ahead > piece->last) piece->end = point;
      piece->first = std::min(piece->first, ahead), piece->last = std::max(piece->last, ahead);
    }
  }
  return piece;
}

struct Section {
  double reach = 0;        ///< ahead of the edge, without gaps
  bool ends_early = true;  ///< on the skin's border
};

Section section_of(const Skin& skin, const SectionPlane& plane, double width) {
  constexpr double gap_fraction = 0.02;     // of the reach: facets of two faces may leave a gap
  constexpr double border_fraction = 0.02;  // of the reach: as near as this is on the border
  std::vector<Piece> pieces;
  for (const Triangle& t : skin.facets) {
    if (const auto piece = cut(t, plane)) pieces.push_back(*piece);
  }
  std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.first < b.first; });
  Section section;
  Vec3 end = plane.origin;
  for (const Piece& piece : pieces) {
    if (piece.first > section.reach + std::max(2 * width, gap_fraction * section.reach)) break;
    if (piece.last > section.reach) section.reach = piece.last, end = piece.end;
  }
  section.ends_early = std::any_of(skin.border.begin(), skin.border.end(), [&](const auto& segment) {
    return distance_to_segment(end, segment[0], segment[1]) < border_fraction * section.reach;
  });
  return section;
}

}  // namespace

double local_chord(const Skin& skin, const ChordPlace& at) {
  // Planes tilted by up to 40 degrees either way: edges are swept (docs/cad_repair.md).
  constexpr int tilts = 4;
  constexpr double step = 10 * std::numbers::pi / 180;
  const Vec3 ahead = normalized(at.into - dot(at.into, at.along) * at.along);
  double chord = 0, across = 0;
  for (int tilt = -tilts; tilt <= tilts; ++tilt) {
    const double c = std::cos(tilt * step), s = std::sin(tilt * step);
    const Section section =
        section_of(skin, {at.place, c * at.along + s * ahead, c * ahead - s * at.along}, at.width);
    if (tilt == 0) across = section.reach;
    if (!section.ends_early && section.reach > 0 && (chord == 0 || section.reach < chord))
      chord = section.reach;
  }
  return chord > 0 ? chord : across;
}

}  // namespace aeroloom::sizing
