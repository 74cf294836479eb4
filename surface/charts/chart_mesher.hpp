/// Meshes a parametric triangulation: a whole face or a part of one. It needs the surface, the vertices on
/// its loops and the size field.
#pragma once

#include "surface/charts/chart_surface.hpp"
#include "surface/remesh/remesh.hpp"

#include <stdexcept>
#include <string>
#include <vector>

namespace aeroloom::surface {

/// The loops of a piece cross under the present sizes. Carries the sources that would lower sizes there, and
/// the keys of the vertices at the ends of crossing edges.
class FaceConflict : public std::runtime_error {
public:
  FaceConflict(const std::string& what, std::vector<sizing::SizeSource> remedy,
               std::vector<mesh::SharedVertexKey> vertices = {})
      : std::runtime_error(what), _remedy(std::move(remedy)), _vertices(std::move(vertices)) {}
  const std::vector<sizing::SizeSource>& remedy() const { return _remedy; }
  const std::vector<mesh::SharedVertexKey>& vertices() const { return _vertices; }

private:
  std::vector<sizing::SizeSource> _remedy;
  std::vector<mesh::SharedVertexKey> _vertices;
};

struct ChartMeshing {
  double chart_spread = 60;   ///< degrees, as SurfaceOptions::chart_spread
  double largest_turn = 0;    ///< radians the surface may turn along an edge, whatever the field says; 0: any
  double least_fraction = 1;  ///< `largest_turn` lowers sizes to no less than this fraction of the field
  bool divides_folds = true;  ///< charts whose border meets itself in the plane alone are divided there
  Remeshing remeshing;
};

/// Maps the surface to charts, fills these by an advancing front, and remeshes in space so that no border
/// between charts shows. Border vertices come first in the result and keep their numbers. Not collective.
/// Throws FaceConflict or SurfaceError.
FaceMesh mesh_charts(const cad::Model& model, const sizing::SizeField& field, const ChartSurface& surface,
                     FaceVertices vertices, const ChartMeshing& options);

}  // namespace aeroloom::surface
