/// Meshes one CAD face: support, charts, front, and the smoothing that leaves no trace of the charts.
#pragma once

#include "mesh/piece.hpp"
#include "surface/curves.hpp"
#include "surface/surface_mesher.hpp"

#include <stdexcept>
#include <vector>

namespace aeroloom::surface {

/// The loops of a face cross each other under the present sizes. Carries where sizes have to fall, and to
/// what.
class FaceConflict : public std::runtime_error {
public:
  FaceConflict(const std::string& what, std::vector<sizing::SizeSource> remedy)
      : std::runtime_error(what), _remedy(std::move(remedy)) {}
  const std::vector<sizing::SizeSource>& remedy() const { return _remedy; }

private:
  std::vector<sizing::SizeSource> _remedy;
};

/// The facets a face's support is made of: they turn by at most options.support_angle and leave the surface
/// by a small part of the model and of the face's width.
geometry::Facets support_facets(const geometry::Model& model, geometry::FaceId face,
                                const SurfaceOptions& options);

/// The triangle piece of a face; piece id = face id. A function of the model, the curves on the face and the
/// field alone: the same bits alone or in a run with others. Not collective. Throws FaceConflict,
/// SurfaceError or geometry::CadError.
mesh::Piece mesh_face(const geometry::Model& model, geometry::FaceId face, const CurveMesh& curves,
                      const sizing::SizeField& field, const SurfaceOptions& options);

}  // namespace aeroloom::surface
