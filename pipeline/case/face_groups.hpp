/// Groups of CAD faces: selected by name, layer, colour, place and so on, with a boundary condition and a
/// size.
#pragma once

#include "cad/model/model.hpp"
#include "geometry/vec.hpp"
#include "mesh/data/patch.hpp"

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace aeroloom::cases {

/// Conditions on a face. All given conditions must hold; of several texts in one condition, one must match.
struct FaceConditions {
  std::vector<std::string> faces = {};   ///< name patterns (cad::NamePattern) of the face or its patch
  std::vector<std::string> parts = {};   ///< name patterns of its part
  std::vector<std::string> layers = {};  ///< name patterns of its layer
  std::vector<std::string> colors = {};  ///< "#rrggbb" or "#rgb", the # may be missing
  std::vector<std::string> ids = {};     ///< face numbers in the file: "7" or "17-20"
  /// The face lies inside this box or on its border. Opposite corners, in the model's unit.
  std::optional<std::pair<geometry::Vec3, geometry::Vec3>> box = {};
  std::optional<geometry::Vec3> normal = {};  ///< direction of its area vector, out of the CAD solid
  std::optional<double> within = {};  ///< largest angle to `normal` in degrees; left out: default_within
  std::optional<std::pair<double, double>> area =
      {};  ///< smallest and largest, in the square of the model's unit
  /// Groups or name patterns of faces: the face shares an edge with one of these faces.
  std::vector<std::string> adjacent_to = {};

  bool empty() const;
};

inline constexpr double default_within = 10;  // degrees

/// A group of the case.
struct GroupRule {
  std::string name;
  FaceConditions all;              ///< must hold; a rule without any condition selects faces of its own name
  std::deque<FaceConditions> any;  ///< if not empty, one of them must hold
  std::deque<FaceConditions> except;    ///< none of them may hold
  bool optional = false;                ///< the group may be empty
  std::optional<mesh::PatchType> type;  ///< boundary condition; empty: the default one
  std::optional<double> size;           ///< largest element size on it, in the model's unit
  std::string where;                    ///< place in the case, for messages: "case.yaml:7:3"
};

struct FaceGroups {
  std::vector<GroupRule> rules;  ///< a face belongs to the first that selects it
  bool strict = false;           ///< every CAD face must be in a group or in a patch of the case
  std::string where;             ///< place of `strict` in the case, for messages
};

inline constexpr std::int32_t no_group = -1;

/// The group of each face; no_group if none selects it. Throws std::invalid_argument, with the place in the
/// case, for a group that selects nothing (with what each condition selects alone, and the nearest names),
/// that loses all faces to earlier groups, or that is defined as its own neighbour.
std::vector<std::int32_t> find_groups(const cad::Model& model, const std::vector<GroupRule>& rules);

/// Checks that the texts are valid colours, numbers and patterns. Throws std::invalid_argument. `path`: key
/// of the conditions.
void check_conditions(const FaceConditions& conditions, const std::string& path);

}  // namespace aeroloom::cases
