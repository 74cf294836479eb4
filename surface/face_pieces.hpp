/// From a CAD face to its pieces.
#pragma once

#include "surface/curves.hpp"
#include "surface/piece_seed.hpp"
#include "surface/surface_mesher.hpp"

#include <vector>

namespace aeroloom::surface {

/// Sizes for background meshes: the fine ones, several times as large.
class CoarseSizes {
public:
  /// The factor follows from the wanted triangles of a piece.
  CoarseSizes(const sizing::SizeField& fine, double piece_triangles);
  double factor(int halvings) const;
  /// Halved so often; made when it is asked for first.
  const sizing::SizeField& field(int halvings);
  const sizing::SizeField& fine() const { return _fine; }

private:
  const sizing::SizeField& _fine;
  double _factor;
  std::vector<sizing::SizeField> _fields;
};

struct FacePieces {
  std::vector<PieceSeed> seeds;
  std::vector<CutAngle> angles;  ///< where cuts end: on feature curves and where they meet
};

/// The pieces of a face: the whole face as long as it is no heavier than a piece should be, else cut along a
/// decomposition of its background mesh. Cuts are straightened, discretised once under the field, and lie on
/// the CAD surface. A function of the arguments alone. Not collective. Throws SurfaceError or
/// geometry::CadError.
FacePieces divide_face(const geometry::Model& model, geometry::FaceId face, const CurveMesh& curves,
                       CoarseSizes& sizes, const SurfaceOptions& options);

}  // namespace aeroloom::surface
