/// Facets of a face on their way to a chart surface: open along seams, with the nodes of each coedge along an
/// edge.
#pragma once

#include "surface/charts/chart_surface.hpp"
#include "surface/charts/surface_topology.hpp"

#include <vector>

namespace aeroloom::surface {

/// A triangulated face as the CAD library leaves it: cut open along seams and at poles.
class OpenFacets {
public:
  OpenFacets(const cad::Model& model, cad::FaceId face, const cad::Facets& facets);

  /// Makes every curve vertex a node of the lines along its edge: nodes at (nearly) the same parameter move
  /// there, the others divide a side of a triangle. Throws SurfaceError where a line is no side of the
  /// triangles.
  void insert_curve_vertices(const CurveMesh& curves);
  /// Gives both coedges along each seam nodes at the same parameters.
  void match_seams();
  /// Connects the points as they lie on the surface, whatever the facets were before curve vertices came in,
  /// and adds points where the surface turns more than a facet should; not where elements of these sizes are
  /// far too large to turn as much.
  void fit_to_surface(const sizing::SizeField& field);
  /// Joins what is one point: both coedges of a seam, the nodes of a degenerate edge, the ends of lines at a
  /// CAD vertex, and points at no distance from each other. Triangles that collapse vanish.
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
  /// Lets nodes of the line become the wanted ones, or adds nodes; lists where they divide triangles.
  void plan(Line& line, const std::vector<Wanted>& wanted, double reuse_tolerance, const SideTable& table,
            std::vector<EdgePoint>& divisions);
  void divide(std::vector<EdgePoint> divisions);
  /// Where the triangulator mixed up the two sides of a seam at a CAD vertex, lines get the end nodes that
  /// lie where the edge's parameter curve ends.
  void match_line_ends();
  Line* other_coedge(const Line& line);
  std::vector<std::int32_t> join_points() const;
  /// 1 where the loops run counter-clockwise in the parameter plane, else -1.
  int parameter_orientation() const;
  void flip(const std::vector<cad::SurfaceFrame>& frames);
  bool is_folded() const;
  void triangulate_again(const std::vector<cad::SurfaceFrame>& frames);
  /// Per half-edge, whether its edge is to be divided; marked on the lower half-edge of the two.
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
