/// Samples of the curvature of a face, kept for several fields.
#pragma once

#include "cad/model/model.hpp"
#include "sizing/field/curvature_size.hpp"
#include "sizing/field/sources.hpp"

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace aeroloom::sizing {

/// Points of a face with the curvature there. The longest edges of facets are bisected as finely as sizes
/// have asked so far; of slender parts only that edge. Nothing is evaluated twice, unless there are too many
/// points to keep. Results do not depend on earlier calls.
class FaceSamples {
public:
  explicit FaceSamples(bool planar) : _planar(planar) {}

  /// Sources on the face, about as dense as their sizes. They ask for what curvature and, off the far field,
  /// surface_maximum ask; none asks for the maximum or more. Every call must give the same face, whatever its
  /// number in the model, and the same facets. `coarsening`: as dense as sizes so many times as large need.
  /// Throws CadError.
  std::vector<SizeSource> sources(const cad::Model& model, cad::FaceId face, const cad::Facets& facets,
                                  bool far_field, const SizingOptions& options, double coarsening = 1);

  /// An overview of the sizes asked for, from the corners of the facets alone.
  struct Overview {
    double triangles = 0;  ///< about
    double parts = 0;      ///< about the number of parts into which sources() cuts the facets
    double area = 0;
    double bounded_area = 0;  ///< where curvature asks for less than the smallest size
    double degrees = 0;       ///< the most that an element turns there
  };
  /// Arguments as for sources().
  Overview overview(const cad::Model& model, cad::FaceId face, const cad::Facets& facets, bool far_field,
                    const SizingOptions& options);

private:
  /// A sampled point. If the parameters jump between two points, the point in their middle asks for what
  /// these two ask.
  struct Point {
    geometry::Vec2 uv;
    geometry::Vec3 point;
    double curvature;                  // the largest, absolute; 0 where there is none
    std::array<std::int32_t, 2> like;  // the two points, or -1
  };
  /// A facet or a part of one. -1 stands for unknown.
  struct Part {
    std::int32_t middle = -1, halves = -1;
  };
  /// Two points by number, the lower one first.
  using Pair = std::uint64_t;
  /// The arguments and results of one call.
  struct Query {
    const cad::Model& model;
    cad::FaceId face;
    const SizingOptions& options;
    CurvatureLimits limits;
    double largest;
    double coarsening = 1;
    std::vector<double> sizes = {};  // of each point; -1: not known yet
    std::vector<SizeSource> sources = {};
    std::unordered_map<std::uint64_t, double> along = {};  // smallest size sampled along lines, by cell
  };

  void start(const Query& query, const cad::Facets& facets);
  std::int32_t add(geometry::Vec2 uv, geometry::Vec3 point, const cad::PrincipalCurvatures& curvatures);
  std::int32_t add_between(const Query& query, std::int32_t a, std::int32_t b, double length);
  std::int32_t middle_of(const Query& query, std::int32_t a, std::int32_t b, double length);
  double size_of(const Point& point, const Query& query) const;
  void add_source(std::int32_t point, Query& query) const;
  void cover(std::int32_t part, const std::array<std::int32_t, 3>& corners, int depth, Query& query);
  void cover_edge(std::int32_t a, std::int32_t b, int depth, Query& query);
  bool is_covered(std::int32_t a, std::int32_t b, Query& query) const;

  bool _planar;
  std::vector<Point> _points;  // those of the facets first
  std::vector<Part> _parts;    // the facets first
  std::unordered_map<Pair, std::int32_t> _middles;
};

}  // namespace aeroloom::sizing
