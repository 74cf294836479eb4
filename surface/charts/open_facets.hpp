/// Facets of a face before they become a closed parametric triangulation. They are open along seams.
#pragma once

#include "surface/charts/chart_surface.hpp"
#include "surface/charts/surface_topology.hpp"

#include <vector>

namespace aeroloom::surface {

/// The facets of a face as the CAD library makes them, cut open along seams and at poles.
class OpenFacets {
public:
  OpenFacets(const cad::Model& model, cad::FaceId face, const cad::Facets& facets);

  /// Puts every curve vertex on the facet edges along its CAD edge. Facet nodes at nearly the same parameter
  /// move there; other curve vertices divide a facet edge. Throws SurfaceError where a CAD edge does not run
  /// along facet edges.
  void insert_curve_vertices(const CurveMesh& curves);
  /// Gives both coedges of each seam nodes at the same parameters.
  void match_seams();
  /// Reconnects the points as they lie on the surface and adds points where the surface turns too much within
  /// a facet. Edges far shorter than the local size are not divided.
  void fit_to_surface(const sizing::SizeField& field);
  /// Merges points that coincide: both coedges of a seam, the nodes of a degenerate edge, ends of edges at
  /// one CAD vertex, and points at zero distance. Drops triangles that collapse.
  ChartSurface close(const CurveMesh& curves, FaceVertices& vertices);

private:
  struct Node {
    double parameter;
    std::int32_t point;
    CurveVertex vertex;  // -1: none
  };
  struct Line {
    cad::Coedge use;
    bool constraining;
    std::vector<Node> nodes;
  };
  /// A node that a line has to get.
  struct Wanted {
    double parameter;
    CurveVertex vertex;
    geometry::Vec3 point;
  };

  class SideTable;
  /// Turns existing nodes of the line into the wanted ones, or adds nodes. Lists the half-edges to divide.
  void plan(Line& line, const std::vector<Wanted>& wanted, double reuse_tolerance, const SideTable& table,
            std::vector<EdgePoint>& divisions);
  void divide(std::vector<EdgePoint> divisions);
  /// Corrects end nodes where the facets have the two sides of a seam exchanged at a CAD vertex: the node
  /// nearest to the end of the parameter curve is taken.
  void match_line_ends();
  Line* other_coedge(const Line& line);
  std::vector<std::int32_t> join_points() const;
  /// 1 where the loops run counter-clockwise in the parameter plane, else -1.
  int parameter_orientation() const;
  void flip(const std::vector<cad::SurfaceFrame>& frames);
  bool is_folded() const;
  void triangulate_again(const std::vector<cad::SurfaceFrame>& frames);
  /// Per half-edge, whether its edge is to be divided. Of the two half-edges the lower is marked.
  std::vector<char> find_turning_edges(const std::vector<geometry::HalfEdge>& twins,
                                       const std::vector<cad::SurfaceFrame>& frames) const;
  bool divide_turning_edges(const std::vector<cad::SurfaceFrame>& frames, const sizing::SizeField& field);
  void collect_vertices(const CurveMesh& curves, FaceVertices& vertices) const;

  const cad::Model& _model;
  ChartSurface _surface;
  std::vector<geometry::Vec2> _uv;  // per point
  std::vector<Line> _lines;
  bool _in_sheets;  // parameters belong to corners of triangles, which are the surface
};

}  // namespace aeroloom::surface
