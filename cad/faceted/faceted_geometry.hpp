/// The faces and edges of a model that are made of flat triangles. Seen by this folder and model/ only.
///
/// Numbers are local: the model numbers its faceted vertices, edges and faces after those of the CAD
/// library's shape.
#pragma once

#include "cad/faceted/facet_links.hpp"
#include "cad/faceted/facet_shape.hpp"
#include "cad/faceted/facet_sheets.hpp"
#include "geometry/box_tree.hpp"

#include <vector>

namespace aeroloom::cad {

struct FacetedFace {
  std::int32_t first = 0, count = 0;  ///< its triangles in the complex
  std::int32_t first_sheet = 0, sheet_count = 0;
  std::vector<std::int32_t> points;                  ///< of the complex, ascending
  std::vector<geometry::TriangleCorners> triangles;  ///< of `points`
  FacetShape shape;
  bool planar = false;
  std::vector<std::vector<Coedge>> loops;  ///< edges are local
  geometry::BoxTree in_space, in_plane;    ///< of its triangles
};

/// One pass of a face along an edge.
struct FacetedUse {
  FaceId face = no_entity;
  bool reversed = false;
  std::vector<geometry::HalfEdge> half_edges;  ///< per side of the edge, of the complex's triangles
};

struct FacetedEdge {
  std::vector<std::int32_t> points;  ///< of the complex
  std::vector<double> along;         ///< per point, the length of the way to it: the edge's parameter
  std::vector<double> curvatures;    ///< per point
  std::vector<FacetedUse> uses;      ///< by face
};

/// Immutable.
class FacetedGeometry {
public:
  /// Of a complex whose triangles are sorted by face and whose faces pass no curve twice
  /// (divide_at_sharp_seams). Lengths beneath `planar_tolerance` do not make a face curved. Throws CadError.
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
  std::int32_t sheet(FaceId face, Vec2 uv) const;  ///< of the face's own, from 0
  /// The nearest point of the face; of two that are about as near, the one on the side of the guess.
  Projection project(FaceId face, Vec3 point, Vec2 guess) const;
  /// The triangles themselves: points once each, with the parameters of one sheet.
  Facets facets(FaceId face) const;
  FacePlace face_place(FaceId face) const;
  double face_area(FaceId face) const;

private:
  /// A place in a triangle of the complex.
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

/// A complex that is ready to be a part: sharp seams divided, sheets cut.
FacetedGeometry make_faceted_geometry(FacetComplex complex);

}  // namespace aeroloom::cad
