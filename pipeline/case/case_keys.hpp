/// The keys of a case: what each accepts, which option of a stage it sets, and what users are told of it.
#pragma once

#include "pipeline/case/case.hpp"
#include "pipeline/case/key_info.hpp"
#include "pipeline/case/source_keys.hpp"
#include "pipeline/case/yaml_reader.hpp"

#include <deque>
#include <optional>

namespace aeroloom::cases {

/// What is built in. The empty name is not among the choices of the key: it stands for a file.
enum class Builtin { none, transport };

/// A case while it is read or written: what is optional in a Case is a value here, with a flag beside it.
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
  // They stay where they are while others are added.
  std::deque<cad::FacetedBody> parts;
  std::deque<PatchRule> patches;
  std::deque<GroupRule> groups;
  std::deque<SourceDraft> sources;
  std::deque<WallRule> walls;
  std::deque<EdgeRule> edges;
  std::deque<LayerRule> layer_rules;
};

/// The unit of lengths in the geometry's own unit.
inline constexpr const char* length_unit = "(length unit of the geometry)";

/// Declares all keys of a case, bound to the draft, which must outlive the table.
void declare_case_keys(KeyTable& root, CaseDraft& draft);

/// Its parts: what is meshed (geometry, far field, patches); how it is improved, judged and written.
void declare_geometry_keys(KeyTable& root, CaseDraft& draft);
void declare_result_keys(KeyTable& root, Case& result);

}  // namespace aeroloom::cases
