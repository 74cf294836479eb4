/// Geometry of faces and edges made of flat triangles: evaluation, projection, facets. Internal to cad/.
///
/// Numbers are local. The model numbers faceted vertices, edges and faces after those of the CAD shape.
#pragma once

#include "cad/faceted/facet_links.hpp"
#include "cad/faceted/facet_shape.hpp"
#include "cad/faceted/facet_sheets.hpp"
#include "geometry/box_tree.hpp"

#include <vector>

namespace aeroloom::cad {

struct FacetedFace {
  std::int32_t first = 0, count = 0;  ///< triangles of the complex
  std::int32_t first_sheet = 0, sheet_count = 0;
  std::vector<std::int32_t> points;                  ///< of the complex, ascending
  std::vector<geometry::TriangleCorners> triangles;  ///< corners are indices into `points`
  FacetShape shape;
  bool planar = false;
  std::vector<std::vector<Coedge>> loops;  ///< local edge numbers
  geometry::BoxTree in_space, in_plane;    ///< boxes of the triangles
};

/// An edge as one face uses it.
struct FacetedUse {
  FaceId face = no_entity;
  bool reversed = false;
  std::vector<geometry::HalfEdge> half_edges;  ///< per side of the edge
};

struct FacetedEdge {
  std::vector<std::int32_t> points;  ///< of the complex
  std::vector<double> along;         ///< parameter of the edge at each point: the length from its start
  std::vector<double> curvatures;    ///< per point
  std::vector<FacetedUse> uses;      ///< sorted by face
};

/// Immutable.
class FacetedGeometry {
public:
  /// Triangles must be sorted by face, and no face may have both sides of a curve (divide_at_sharp_seams). A
  /// face is planar if it leaves a plane by at most `planar_tolerance`. Throws CadError.
  FacetedGeometry(FacetComplex complex, FacetSheets sheets, double planar_tolerance);

  const FacetComplex& complex() const { return _complex; }
  const FacetSheets& sheets() const { return _sheets; }
  double planar_tolerance() const { return _planar_tolerance; }
  const std::vector<FacetedFace>& faces() const { return _faces; }
  const std::vector<FacetedEdge>& edges() const { return _edges; }
  const std::vector<CornerUv>& corner_uv() const { return _uv; }  ///< per triangle of the complex

  Vec3 edge_point(EdgeId edge, double parameter) const;
  Vec3 edge_tangent(EdgeId edge, double parameter) const;
  double edge_curvature(EdgeId edge, double parameter) const;
  Vec2 edge_uv(EdgeId edge, FaceId face, double parameter) const;

  Vec3 face_point(FaceId face, Vec2 uv) const;
  SurfaceFrame face_frame(FaceId face, Vec2 uv) const;
  PrincipalCurvatures face_curvatures(FaceId face, Vec2 uv) const;
  std::int32_t sheet(FaceId face, Vec2 uv) const;  ///< number among the face's sheets
  /// The nearest point of the face. If two points are about equally near, the one that a walk from the guess
  /// reaches.
  Projection project(FaceId face, Vec3 point, Vec2 guess) const;
  /// The triangles of the face. Each point occurs once, with its parameters in one sheet.
  Facets facets(FaceId face) const;
  FacePlace face_place(FaceId face) const;
  double face_area(FaceId face) const;

private:
  /// A point in a triangle, in barycentric coordinates.
  struct Place {
    std::int32_t triangle = -1;
    std::array<double, 3> weights{};
  };
  struct Foot {
    Place place;
    Vec3 point;
    double away = 0;
  };
  Place locate(FaceId face, Vec2 uv) const;
  Vec3 point_at(const Place& place) const;
  Vec2 uv_at(const Place& place) const;
  Foot foot_on(std::int32_t triangle, Vec3 point) const;
  Foot descend(std::int32_t triangle, Vec3 point) const;
  std::size_t side_at(const FacetedEdge& edge, double parameter, double& fraction) const;

  void collect_faces();
  void collect_edges();
  void trace_loops();
  bool lies_in_plane(const FacetedFace& face) const;

  FacetComplex _complex;
  FacetSheets _sheets;
  double _planar_tolerance;
  FacetLinks _links;
  std::vector<CornerUv> _uv;
  std::vector<FacetedFace> _faces;
  std::vector<FacetedEdge> _edges;
};

/// How far a face may leave a plane that counts as planar: what rounding of its file leaves.
double planar_tolerance_of(const FacetComplex& complex);

/// Divides sharp seams, cuts sheets and makes the geometry.
FacetedGeometry make_faceted_geometry(FacetComplex complex);
FacetedGeometry make_faceted_geometry(FacetComplex complex, double planar_tolerance);

}  // namespace aeroloom::cad
