/// Distances to opposite walls: how thin a body or a gap is.
#pragma once

#include "cad/model/model.hpp"
#include "sizing/features/facet_parameters.hpp"
#include "sizing/features/ray_tree.hpp"
#include "sizing/features/triangle_tree.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

namespace aeroloom::sizing {

/// Rays on a facet that is bisected down to an edge, times the square of that edge, over its area.
inline constexpr double rays_per_area = 24;

/// A point of a face with the distance to the wall opposite to it.
struct Gap {
  geometry::Vec3 point;
  double width;
  bool is_meshed = true;  ///< whether what lies between is; if not, that is a thin part of a body
};

/// Gaps that rays from one face have met.
struct Gaps {
  std::vector<Gap> seen;  ///< the narrower one on meshed sides of the face, and one through the body
  /// On a side that is meshed, and where the walls do not run together towards a common edge: elements as
  /// small as the gap resolve it. A wedge looks the same to elements of any size. Where facets are less than
  /// twice their distance from the surface apart, the gap is that between the surfaces; none where these run
  /// together towards a common edge nearer than the facets are long.
  std::vector<Gap> open;
  /// A part of a facet that is longer than rays should be apart in the open gap there.
  struct Part {
    Triangle triangle;
    double gap;
    std::int32_t facet;  ///< of the face
    int depth;           ///< how often it was bisected for that
  };
  std::vector<Part> narrow;
  /// A part of a facet that was not looked at, for the work that would have been.
  struct Unseen {
    Triangle triangle;
    std::int32_t facet;  ///< of the face
    int depth;           ///< how often that was bisected
  };
  std::vector<Unseen> unseen;
};

/// The distance of each facet's middle from the face's surface: nothing of a plane, at most a quarter of its
/// longest edge.
std::vector<double> facet_deviations(const cad::Model& model, cad::FaceId face, const cad::Facets& facets);

/// A facet as a wall.
struct Wall {
  cad::FaceId face;
  Triangle corners;
  Parameters parameters;  ///< of its corners
  double deviation;       ///< its distance from the surface

  static constexpr auto fields() {
    return std::tuple(&Wall::face, &Wall::corners, &Wall::parameters, &Wall::deviation);
  }
};

/// The facets of all faces.
struct Walls {
  TriangleTree tree;
  RayTree rays;
  std::vector<geometry::Vec3> normals;  ///< unit; zero where a triangle has none
  std::vector<Wall> facets;

  explicit Walls(std::vector<Wall> walls);
};

/// Limits to the cost of a search for gaps, and the gaps that it looks for.
struct GapLimits {
  double widest;  ///< gaps wider than this are left out
  double finest;  ///< no parts of facets are bisected whose edges are no longer than this
  double layers;  ///< elements wanted across a gap, at most
};

/// Rays, and the nodes of trees that they have visited.
struct LookedAt {
  std::int64_t rays, nodes;
};

/// Looks for gaps seen from one face, given by its facets: rays along its facets' normals, to both sides, to
/// the nearest wall that faces back. Facets are bisected until their edges are no longer than four times the
/// gap or `finest`. Wedges, where the opposite wall meets the face in an edge nearer than eight times the
/// gap, are left out: sizes would fall to nothing there. A function of the model and the arguments alone,
/// counts of nodes included, to which a projection on a surface adds as many as it takes time.
class FaceGapSearch {
public:
  /// All arguments but the limits must outlive the search.
  FaceGapSearch(const cad::Model& model, cad::FaceId face, const cad::Facets& facets, const Walls& walls,
                const GapLimits& limits);
  ~FaceGapSearch();
  FaceGapSearch(FaceGapSearch&&) noexcept;
  FaceGapSearch& operator=(FaceGapSearch&&) noexcept;

  /// Goes on until everything was looked at, or until about so many nodes of trees more were visited, which
  /// are assigned to facets by area and to their parts; returns how many were.
  std::int64_t go_on(std::int64_t nodes, Gaps& gaps);

  /// Looks at the narrow parts of the face as closely as its open gaps are narrow, with rays `apart` times as
  /// far from each other, and moves on from there: adds to the open gaps. The parts that are longest for the
  /// gap seen in them come first, so what `most` leaves is looked at about as closely everywhere. Parts that
  /// are longer than gaps ask for stay in gaps.narrow, for another look. Returns what it took.
  LookedAt look_closer(double apart, const LookedAt& most, Gaps& gaps);

private:
  class Rays;
  std::unique_ptr<Rays> _rays;
};

/// The narrow part that is longest for the gap seen in it, where it is far longer than that asks for; null
/// where none is.
const Gaps::Part* find_coarsest(const Gaps& gaps, double layers);

/// About as many rays as it takes to look at the narrow parts of a face as closely as its open gaps are
/// narrow, as far as those have been seen.
std::int64_t count_rays(const Gaps& gaps, double layers);

}  // namespace aeroloom::sizing
