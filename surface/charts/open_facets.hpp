/// Facets of a face before they become a closed parametric triangulation. They are open along seams.
#pragma once

#include "surface/charts/chart_surface.hpp"
#include "surface/charts/surface_topology.hpp"
#include "surface/rows/face_rows.hpp"

#include <map>
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
  /// Takes the strips of rows away: the boundary runs along their tops then. Before the curve vertices there
  /// are in place. Where strips meet each other or the boundary, their columns are listed among the failures.
  void cut_off(FaceRows& rows, const CurveMesh& curves);
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
    CurveVertex vertex;  // -1: none; tops of rows are numbered behind those of the curves
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
  /// From points and lines. False where lines touch, and nothing has changed then; `crossings` gets the
  /// points of edges that do.
  bool triangulate_again(const std::vector<cad::SurfaceFrame>& frames, std::vector<std::int32_t>& crossings);
  /// Per half-edge, whether its edge is to be divided. Of the two half-edges the lower is marked.
  std::vector<char> find_turning_edges(const std::vector<geometry::HalfEdge>& twins,
                                       const std::vector<cad::SurfaceFrame>& frames) const;
  bool divide_turning_edges(const std::vector<cad::SurfaceFrame>& frames, const sizing::SizeField& field);
  /// Nodes of columns with rows become their tops. `columns` gets, by point of a top, what fails if it is in
  /// the way.
  void lower_to_tops(Line& line, const RowStrip& strip, const CurveMesh& curves,
                     std::map<std::int32_t, RowFailure>& columns);
  bool is_top(CurveVertex vertex) const { return !_tops.empty() && vertex >= _first_top; }
  mesh::SharedVertexKey key_of(const CurveMesh& curves, CurveVertex vertex) const;
  geometry::Vec3 point_of(const CurveMesh& curves, CurveVertex vertex) const;
  void collect_vertices(const CurveMesh& curves, FaceVertices& vertices) const;

  const cad::Model& _model;
  ChartSurface _surface;
  std::vector<geometry::Vec2> _uv;  // per point
  std::vector<Line> _lines;
  CurveVertex _first_top = 0;  // the number of the first top of rows
  std::vector<geometry::Vec3> _tops;
  std::vector<mesh::SharedVertexKey> _top_keys;
  bool _in_sheets;  // parameters belong to corners of triangles, which are the surface
};

}  // namespace aeroloom::surface
