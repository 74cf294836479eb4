/// Charts whose border meets itself in the plane, though it does not in space. They are found on the border
/// of the triangulation and on its triangles, and divided where they meet.
#pragma once

#include "surface/charts/chart.hpp"
#include "surface/charts/cut_curves.hpp"

#include <array>
#include <optional>
#include <vector>

namespace aeroloom::surface {

/// Two edges of the border of a chart that meet in the plane, as points of its surface.
struct BorderMeeting {
  std::array<std::array<std::int32_t, 2>, 2> edges;
};

/// What finer sizes cannot part: the map folds, and no chord of a curve is at fault.
struct ChartFold {
  std::optional<BorderMeeting> meeting;  ///< nothing: only triangles are turned over, or none
};

/// Looks at places where chords of the border cross: `chords` are pairs of numbers of its loop edges. A place
/// is a fold where the border between the ends of both chords crosses too, or where a triangle beside them is
/// turned over. Without chords the whole border is looked at, and there is always a fold.
std::optional<ChartFold> find_fold(const Chart& chart,
                                   const std::vector<std::array<std::int32_t, 2>>& chords);

/// Per point of the surface, half the difference of the ways over its edges to the two edges: zero along the
/// medial line between them.
std::vector<double> medial_levels(const ChartSurface& surface, const BorderMeeting& meeting);

struct FoldedChart {
  const Chart& chart;
  ChartFold fold;
};

/// Divides a chart along the medial line between the edges that meet, else by a plane, and maps the parts
/// anew. The cut is discretised under the field, and its vertices are appended to `vertices`. No edge of it
/// joins a pair in `joined`. Nothing, and `vertices` as before, where it cannot be divided. Deterministic.
std::vector<Chart> divide_chart(const cad::Model& model, const sizing::SizeField& field,
                                const FoldedChart& folded, const ChartLimits& limits,
                                const JoinedVertices& joined, FaceVertices& vertices);

}  // namespace aeroloom::surface
