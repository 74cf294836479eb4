/// Faces that meet conditions.
#pragma once

#include "pipeline/case/face_groups.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace aeroloom::cases {

/// The faces that meet one condition.
struct FoundFaces {
  std::string what;         ///< "in the box"
  std::vector<char> faces;  ///< by face id
};

/// The rule in messages: its place in the case and its key.
std::string origin_of(const GroupRule& rule);

/// Selects faces by rules, each once; what conditions need of the CAD is computed where one asks. Model and
/// rules must outlive it. Throws std::invalid_argument for texts that no face has, where the rule is not
/// optional, and for rules in a circle.
class FaceFinder {
public:
  FaceFinder(const cad::Model& model, const std::vector<GroupRule>& rules)
      : _model(model), _rules(rules), _selected(rules.size()), _busy(rules.size(), 0) {}

  /// The faces that a rule selects, whatever others do. Far field and plane of symmetry only where it names
  /// them.
  const std::vector<char>& faces_of(std::size_t rule);
  /// What each of its conditions finds by itself.
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
  /// Whether the rule has the face's name, or that of its patch, word for word.
  bool names(const GroupRule& rule, cad::FaceId face) const;
  [[noreturn]] void refuse(const GroupRule& rule, const char* what, const std::string& text,
                           const Names& names) const;

  const cad::Model& _model;
  const std::vector<GroupRule>& _rules;
  std::vector<std::vector<char>> _selected;  // by rule; empty where it was not asked for
  std::vector<char> _busy;                   // rules whose neighbours are looked for
};

}  // namespace aeroloom::cases
