/// The keys of a case: what each accepts and which option of a stage it sets.
#pragma once

#include "pipeline/case.hpp"
#include "pipeline/yaml_reader.hpp"

#include <deque>
#include <optional>

namespace aeroloom::pipeline {

/// What is built in. The empty name is not among the choices of the key: it stands for a file.
enum class Builtin { none, transport };

/// A case while it is read or written: what is optional in a Case is a value here, with a flag beside it.
struct CaseDraft {
  Case result;
  Builtin builtin = Builtin::none;
  cad::TransportDimensions dimensions;
  bool dimensions_given = false;
  cad::FarFieldOptions far_field;
  bool far_field_given = false;
  std::optional<double> sharpen_width;
  std::deque<PatchRule> patches;  ///< they stay where they are while others are added
};

/// Declares all keys of a case, bound to the draft, which must outlive the table.
void declare_case_keys(KeyTable& root, CaseDraft& draft);

}  // namespace aeroloom::pipeline
