/// Finds the CAD faces that meet the conditions of a group.
#pragma once

#include "pipeline/case/face_groups.hpp"

#include <functional>
#include <string>
#include <vector>

namespace aeroloom::cases {

/// The faces that meet one condition.
struct FoundFaces {
  std::string what;         ///< in words: "in the box"
  std::vector<char> faces;  ///< by face id
};

/// The rule as messages name it: its place in the case and its key.
std::string origin_of(const GroupRule& rule);

/// Selects faces by rules. Areas, boxes and normals are computed when a condition first needs them. Model and
/// rules must outlive the finder. Throws std::invalid_argument for a text that matches no face (unless the
/// rule is optional) and for rules that refer to each other in a circle.
class FaceFinder {
public:
  FaceFinder(const cad::Model& model, const std::vector<GroupRule>& rules)
      : _model(model), _rules(rules), _selected(rules.size()), _busy(rules.size(), 0) {}

  /// The faces that a rule selects, regardless of other rules. Far field and symmetry plane are selected only
  /// by name.
  const std::vector<char>& faces_of(std::size_t rule);
  /// The faces that each condition of the rule selects alone.
  std::vector<FoundFaces> explain(std::size_t rule);

private:
  using Names = std::function<std::vector<std::string>(cad::FaceId)>;

  std::vector<FoundFaces> look(const FaceConditions& conditions, const GroupRule& rule);
  std::vector<char> meet(const FaceConditions& conditions, const GroupRule& rule);
  std::vector<char> with_names(const std::vector<std::string>& patterns, const GroupRule& rule,
                               const char* what, const Names& names) const;
  std::vector<char> with_colors(const std::vector<std::string>& colors, const GroupRule& rule) const;
  std::vector<char> with_numbers(const std::vector<std::string>& ids, const GroupRule& rule) const;
  std::vector<char> with_direction(geometry::Vec3 direction, double within) const;
  std::vector<char> within_box(const geometry::Box& box) const;
  std::vector<char> beside(const std::vector<std::string>& others, const GroupRule& rule);
  std::vector<char> where(const std::function<bool(cad::FaceId)>& holds) const;
  /// Whether the rule names the face or its patch literally, without wildcards.
  bool names(const GroupRule& rule, cad::FaceId face) const;
  [[noreturn]] void refuse(const GroupRule& rule, const char* what, const std::string& text,
                           const Names& names) const;

  const cad::Model& _model;
  const std::vector<GroupRule>& _rules;
  std::vector<std::vector<char>> _selected;  // by rule; empty until needed
  std::vector<char> _busy;                   // by rule: its neighbours are being searched for
};

}  // namespace aeroloom::cases
