/// Fills what a piece is made of: a chart surface, the vertices on its loops, and sizes. Nothing else is
/// known here, so a whole face and a part of one are meshed alike.
#pragma once

#include "surface/charts/chart_surface.hpp"
#include "surface/remesh/remesh.hpp"

#include <stdexcept>
#include <string>
#include <vector>

namespace aeroloom::surface {

/// The loops of a piece cross each other under the present sizes. Carries where sizes have to fall, and to
/// what, and the vertices with names at the ends of edges that cross.
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
  double largest_turn = 0;    ///< radians the surface may turn along an edge, whatever the field; 0: any
  double least_fraction = 1;  ///< of the field's size, that turns may ask for
  Remeshing remeshing;
};

/// Charts, front, and the smoothing that leaves no trace of the charts. Of `vertices` those on borders come
/// first in the result and keep their numbers. Not collective. Throws FaceConflict or SurfaceError.
FaceMesh mesh_charts(const cad::Model& model, const sizing::SizeField& field, const ChartSurface& surface,
                     FaceVertices vertices, const ChartMeshing& options);

}  // namespace aeroloom::surface
