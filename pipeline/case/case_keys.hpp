/// All keys of a case: accepted values, the option that each key sets, and its documentation.
#pragma once

#include "pipeline/case/case.hpp"
#include "pipeline/case/key_info.hpp"
#include "pipeline/case/source_keys.hpp"
#include "pipeline/case/yaml_reader.hpp"

#include <deque>
#include <optional>

namespace aeroloom::cases {

/// Names of built-in geometries. The empty name means that a file is given; it is not a choice of the key.
enum class Builtin { none, transport };

/// A case while it is read or written. Optional members of Case are plain values with flags here.
struct CaseDraft {
  Case result;
  Builtin builtin = Builtin::none;
  cad::TransportDimensions dimensions;
  bool dimensions_given = false;
  cad::FarFieldOptions far_field;
  std::optional<double> extent;  // of the far field
  std::optional<cad::ExtentUnit> extent_unit;
  bool far_field_given = false;
  std::optional<double> sharpen_width;
  // Deques: addresses stay valid while items are added.
  std::deque<cad::FacetedBody> parts;
  std::deque<PatchRule> patches;
  std::deque<GroupRule> groups;
  std::deque<SourceDraft> sources;
  std::deque<WallRule> walls;
  std::deque<EdgeRule> edges;
  std::deque<LayerRule> layer_rules;
};

/// The unit of lengths: that of the geometry.
inline constexpr const char* length_unit = "(length unit of the geometry)";

/// Declares all keys of a case, bound to `draft`. The draft must outlive the table.
void declare_case_keys(KeyTable& root, CaseDraft& draft);

/// The two halves of declare_case_keys(): geometry, far field, patches; then improvement, gate, output.
void declare_geometry_keys(KeyTable& root, CaseDraft& draft);
void declare_result_keys(KeyTable& root, Case& result);

}  // namespace aeroloom::cases
