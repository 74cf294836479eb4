/// Findings of the sizing stage about walls close to each other.
#pragma once

#include "cad/model/model.hpp"
#include "geometry/vec.hpp"
#include "sizing/field/size_field.hpp"

#include <string>
#include <vector>

namespace aeroloom::sizing {
class FieldFactory;
struct CoincidentFaces;
}  // namespace aeroloom::sizing

namespace aeroloom::domain {

/// A face on which the search for gaps ended early.
struct UnseenWalls {
  std::string face;
  geometry::Vec3 place;  ///< centre of the largest region not searched
  double size;           ///< of that region
};

/// Two faces that lie on one another, closer than elements can separate.
struct FacesOnOneAnother {
  std::string first, second;
  double area;           ///< approximate common area
  geometry::Vec3 place;  ///< in the common area
  double apart;          ///< largest distance
  double triangles = 0;  ///< on each, if the gap between them were meshed; 0: there is no volume between them
};

struct WallFindings {
  std::vector<UnseenWalls> unseen;
  std::vector<FacesOnOneAnother> coincident;  ///< largest areas first
};

/// Converts findings to names. Keeps only coincident faces that the field does not separate. `model`: where
/// the faces were found; `factory`: of the model to mesh.
WallFindings report_walls(const cad::Model& model, const std::vector<sizing::CoincidentFaces>& coincident,
                          const sizing::FieldFactory& factory, const sizing::SizeField& field);

/// A message about searches that ended early; may be empty.
std::string describe(const std::vector<UnseenWalls>& unseen);
/// Explains why no mesh can be made, with a remedy; may be empty.
std::string describe(const std::vector<FacesOnOneAnother>& coincident);

}  // namespace aeroloom::domain
