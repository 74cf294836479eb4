/// Samples of a face that serve all sizes.
#pragma once

#include "cad/model/model.hpp"
#include "sizing/field/curvature_size.hpp"
#include "sizing/field/sources.hpp"

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace aeroloom::sizing {

/// Points of a face with the curvature there, found by bisecting the longest edges of its facets as finely as
/// sizes have asked for so far, of slender parts that edge alone, and only where none was beside it: what was
/// evaluated once serves all sizes that come later, unless it is so much that it is not worth its memory.
/// What comes out does not depend on what was asked before.
class FaceSamples {
public:
  explicit FaceSamples(bool planar) : _planar(planar) {}

  /// Sources that cover the face about as densely as the sizes they ask for: curvature, and surface_maximum
  /// off the far field. Nowhere the maximum or more. Always called with the same face, whatever its number in
  /// the model, and its facets. `coarser`: as densely as sizes so many times as large would. Throws CadError.
  std::vector<SizeSource> sources(const cad::Model& model, cad::FaceId face, const cad::Facets& facets,
                                  bool far_field, const SizingOptions& options, double coarser = 1);

  /// The sizes asked for, told by the corners of the facets alone.
  struct Overview {
    double triangles = 0;  ///< about
    double parts =
        0;  ///< that sources() cuts it into, about, by the corner of each facet that asks for least
    double area = 0;
    double bounded_area = 0;  ///< where curvature asks for less than the smallest size
    double degrees = 0;       ///< that an element turns there, at most
  };
  /// As sources().
  Overview overview(const cad::Model& model, cad::FaceId face, const cad::Facets& facets, bool far_field,
                    const SizingOptions& options);

private:
  /// Where the parameters jump between two points, the one in their middle asks for what they ask for.
  struct Point {
    geometry::Vec2 uv;
    geometry::Vec3 point;
    double curvature;                  // the largest, absolute; 0 where there is none
    std::array<std::int32_t, 2> like;  // those two, or -1
  };
  /// A facet or a part of one: the point in the middle of its longest edge and the first of its halves; -1:
  /// unknown.
  struct Part {
    std::int32_t middle = -1, halves = -1;
  };
  /// Two points by number, the lower one first.
  using Pair = std::uint64_t;
  /// The request of one call.
  struct Demand {
    const cad::Model& model;
    cad::FaceId face;
    const SizingOptions& options;
    CurvatureLimits limits;
    double largest;
    double coarser = 1;
    std::vector<double> sizes = {};  // per point; -1 where none is asked for yet
    std::vector<SizeSource> sources = {};
    std::unordered_map<std::uint64_t, double> along = {};  // smallest size sampled along lines, by cell
  };

  void start(const Demand& demand, const cad::Facets& facets);
  std::int32_t add(geometry::Vec2 uv, geometry::Vec3 point, const cad::PrincipalCurvatures& curvatures);
  std::int32_t add_between(const Demand& demand, std::int32_t a, std::int32_t b, double length);
  std::int32_t middle_of(const Demand& demand, std::int32_t a, std::int32_t b, double length);
  double size_of(const Point& point, const Demand& demand) const;
  void ask(std::int32_t point, Demand& demand) const;
  void cover(std::int32_t part, const std::array<std::int32_t, 3>& corners, int depth, Demand& demand);
  void cover_edge(std::int32_t a, std::int32_t b, int depth, Demand& demand);
  bool is_covered(std::int32_t a, std::int32_t b, Demand& demand) const;

  bool _planar;
  std::vector<Point> _points;  // those of the facets first
  std::vector<Part> _parts;    // the facets first
  std::unordered_map<Pair, std::int32_t> _middles;
};

}  // namespace aeroloom::sizing
