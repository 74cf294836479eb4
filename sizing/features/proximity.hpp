/// How thin a body or a gap is: distances to opposite faces.
#pragma once

#include "cad/model/model.hpp"
#include "sizing/features/facet_parameters.hpp"
#include "sizing/features/ray_tree.hpp"
#include "sizing/features/triangle_tree.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace aeroloom::sizing {

/// The number of rays on a facet that is bisected to some edge length, times that length squared, over the
/// area.
inline constexpr double rays_per_area = 24;

/// A point of a face, and the distance to the face opposite to it.
struct Gap {
  geometry::Vec3 point;
  double width;
  bool is_meshed = true;  ///< the space between is meshed; if not, it is a thin part of a body
  double bend = 0;        ///< of a thin part: the largest curvatures of both its sides, added
};

/// The largest size with which triangles on both sides of a thin part stay half its width away from each
/// other: those of an edge h leave a surface of curvature k by h^2 k / 6. Infinite where both sides are
/// planar.
double size_that_keeps_apart(double width, double bend);

/// Gaps that rays from one face have met.
struct Gaps {
  std::vector<Gap> seen;  ///< by ray: the narrower gap on meshed sides, and that through the body
  /// Gaps on a meshed side whose faces do not run towards a common edge. Elements as small as the gap resolve
  /// these; a wedge looks the same to elements of any size. If the gap is less than twice the distance of
  /// facets from the surface, the distance of the surfaces counts. There is no gap if these run towards a
  /// common edge nearer than the facets are long.
  std::vector<Gap> open;
  /// A part of a facet that is too long for the open gap seen from it.
  struct Part {
    Triangle triangle;
    double gap;
    std::int32_t facet;  ///< of the face
    int depth;           ///< number of bisections for the open gap
  };
  std::vector<Part> narrow;
  /// A part of a facet that was not searched, because the work was used up.
  struct Unseen {
    Triangle triangle;
    std::int32_t facet;  ///< of the face
    int depth;           ///< number of bisections
  };
  std::vector<Unseen> unseen;
};

/// The distance of the middle of each facet from the surface of its face. It is zero on a plane, and at most
/// a quarter of the longest edge.
std::vector<double> facet_deviations(const cad::Model& model, cad::FaceId face, const cad::Facets& facets);

/// The largest curvature of the face at the corners of each facet; zero on a plane.
std::vector<double> facet_curvatures(const cad::Model& model, cad::FaceId face, const cad::Facets& facets);

/// A facet of a face.
struct ModelFacet {
  cad::FaceId face;
  Triangle corners;
  Parameters parameters;  ///< of its corners
  double deviation;       ///< its distance from the surface
  double curvature;       ///< the largest at its corners
};

/// The facets of all faces, in trees.
struct ModelFacets {
  TriangleTree tree;
  RayTree rays;
  std::vector<geometry::Vec3> normals;  ///< unit; zero where a triangle has none
  std::vector<ModelFacet> items;

  explicit ModelFacets(std::vector<ModelFacet> all);
};

/// Limits of a search for gaps.
struct GapLimits {
  double widest;       ///< gaps wider than this are left out
  double finest;       ///< parts of facets with edges up to this length are not bisected
  double layers;       ///< the most elements wanted across a gap
  bool thin_by_width;  ///< and across thin parts; else sizes there keep triangles of both sides apart
};

/// The number of rays, and of visited tree nodes.
struct LookedAt {
  std::int64_t rays, nodes;
};

/// Searches the gaps seen from one face. Rays leave its facets along the normals, to both sides, up to the
/// nearest face that faces back. Facets are bisected until their edges are at most four times the gap, or
/// `finest`. A wedge is left out: there the opposite face meets this one in an edge nearer than eight times
/// the gap, and sizes would fall to nothing. The result and the counts of nodes depend on the model and the
/// arguments alone. A projection on a surface counts as 100 nodes, for the time it takes.
class FaceGapSearch {
public:
  /// All arguments but the limits must outlive the search.
  FaceGapSearch(const cad::Model& model, cad::FaceId face, const cad::Facets& facets, const ModelFacets& all,
                const GapLimits& limits);

  /// Continues the search until everything was searched, or until about `nodes` more tree nodes were visited.
  /// These are assigned to facets and their parts by area. Returns the number of visited nodes.
  std::int64_t go_on(std::int64_t nodes, Gaps& gaps);

  /// Searches the narrow parts of the face more closely, as its open gaps need, with rays `apart` times as
  /// far from each other. Adds to the open gaps. Parts that are longest for their gap come first, so that
  /// `most` leaves all parts about equally fine. Parts that are still too long remain in gaps.narrow. Returns
  /// the work done.
  LookedAt look_closer(double apart, const LookedAt& most, Gaps& gaps);

private:
  class Rays;
  std::shared_ptr<Rays> _rays;
};

/// The narrow part that is longest for the gap seen in it, if it is far too long; null if there is none.
const Gaps::Part* find_coarsest(const Gaps& gaps, double layers);

/// About the number of rays that the narrow parts of a face need, as far as their gaps are known.
std::int64_t count_rays(const Gaps& gaps, double layers);

}  // namespace aeroloom::sizing
