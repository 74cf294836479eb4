/// Findings of the sizing stage about walls that are close to each other.
#pragma once

#include "cad/model/model.hpp"
#include "geometry/vec.hpp"
#include "sizing/field/size_field.hpp"

#include <string>
#include <tuple>
#include <vector>

namespace aeroloom::sizing {
class FieldFactory;
struct CoincidentFaces;
}  // namespace aeroloom::sizing

namespace aeroloom::domain {

/// A face on which the search for gaps ended early.
struct UnseenWalls {
  std::string face;
  geometry::Vec3 place;  ///< middle of the largest part that was not looked at
  double size;           ///< of that part

  static constexpr auto fields() {
    return std::tuple(&UnseenWalls::face, &UnseenWalls::place, &UnseenWalls::size);
  }
};

/// Two faces that lie on one another where elements are so large that they cannot tell them apart.
struct FacesOnOneAnother {
  std::string first, second;
  double area;           ///< over which they do, about
  geometry::Vec3 place;  ///< there
  double apart;          ///< at most

  static constexpr auto fields() {
    return std::tuple(&FacesOnOneAnother::first, &FacesOnOneAnother::second, &FacesOnOneAnother::area,
                      &FacesOnOneAnother::place, &FacesOnOneAnother::apart);
  }
};

struct WallFindings {
  std::vector<UnseenWalls> unseen;
  std::vector<FacesOnOneAnother> coincident;  ///< by area, the largest first

  static constexpr auto fields() { return std::tuple(&WallFindings::unseen, &WallFindings::coincident); }
};

/// By name; of the coincident faces those that the field does not tell apart. `model` is the one in which
/// they were found, `factory` that of the model to mesh.
WallFindings report_walls(const cad::Model& model, const std::vector<sizing::CoincidentFaces>& coincident,
                          const sizing::FieldFactory& factory, const sizing::SizeField& field);

/// Where the search for gaps ended early; empty where it did not.
std::string describe(const std::vector<UnseenWalls>& unseen);
/// Why there can be no mesh, with the remedy; empty where nothing is in the way.
std::string describe(const std::vector<FacesOnOneAnother>& coincident);

}  // namespace aeroloom::domain
