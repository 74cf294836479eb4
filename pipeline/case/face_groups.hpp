/// Groups of faces: which faces of the CAD they select, and what they are to mesh and solver.
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

/// Conditions for a face; those that are there must all hold, of the texts in one condition one.
struct FaceConditions {
  std::vector<std::string> faces = {};   ///< patterns (cad::NamePattern) of its name or that of its patch
  std::vector<std::string> parts = {};   ///< patterns of the name of its part
  std::vector<std::string> layers = {};  ///< patterns of its layer
  std::vector<std::string> colors = {};  ///< "#rrggbb" or "#rgb", with or without #
  std::vector<std::string> ids = {};     ///< its number in the file, or two of them with - between
  /// It lies within, the border included; opposite corners, in the model's unit.
  std::optional<std::pair<geometry::Vec3, geometry::Vec3>> box = {};
  std::optional<geometry::Vec3> normal = {};  ///< direction of its area vector, out of the solid of the CAD
  std::optional<double> within = {};          ///< degrees between the two, at most; left out: default_within
  std::optional<std::pair<double, double>> area = {};  ///< from, to; in the square of the model's unit
  /// Groups, or patterns of faces: it has an edge in common with one of theirs.
  std::vector<std::string> adjacent_to = {};

  bool empty() const;
};

inline constexpr double default_within = 10;  // degrees

/// A group of the case.
struct GroupRule {
  std::string name;
  FaceConditions all;                   ///< must hold; with nothing in the whole rule: the faces of this name
  std::deque<FaceConditions> any;       ///< one of them must hold, where there are any
  std::deque<FaceConditions> except;    ///< none of them may hold
  bool optional = false;                ///< it may select nothing
  std::optional<mesh::PatchType> type;  ///< empty: what suits it by default
  std::optional<double> size;           ///< largest size of elements on it, in the model's unit
  std::string where;                    ///< in the case, for messages: "case.yaml:7:3"
};

struct FaceGroups {
  std::vector<GroupRule> rules;  ///< the first that selects a face has it
  bool strict = false;  ///< a face of the CAD in none of them, nor in a patch of the case, is an error
  std::string where;    ///< of `strict` in the case, for messages
};

inline constexpr std::int32_t no_group = -1;

/// The group of each face; no_group where none selects it. Throws std::invalid_argument with the place in the
/// case for a group that selects nothing (what each condition finds by itself, and the nearest names), whose
/// faces are all taken by groups before it, or that is next to itself round a circle of groups.
std::vector<std::int32_t> find_groups(const cad::Model& model, const std::vector<GroupRule>& rules);

/// Throws std::invalid_argument for texts that are no colour, no number, no expression; `path` is the key
/// that has the conditions.
void check_conditions(const FaceConditions& conditions, const std::string& path);

}  // namespace aeroloom::cases
