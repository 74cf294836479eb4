/// A commented case to start from.
#pragma once

#include "pipeline/case/key_info.hpp"

#include <string>
#include <vector>

namespace aeroloom::cases {

struct TemplateRequest {
  std::string geometry;  ///< the CAD file; empty: the user fills it in
  bool every_key = false;
  std::string schema;  ///< where editors find the schema, seen from the case; empty: not told
};

/// YAML that read_case accepts once `geometry.file` is set. Each key has its text, what it accepts and what
/// it is when left out, and stands there commented out: at its default, or else with an example that says so.
std::string case_template(const std::vector<KeyInfo>& keys, const TemplateRequest& request);

}  // namespace aeroloom::cases
