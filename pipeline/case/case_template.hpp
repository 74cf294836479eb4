/// Writes a commented case file to start from.
#pragma once

#include "pipeline/case/key_info.hpp"

#include <string>
#include <vector>

namespace aeroloom::cases {

struct TemplateRequest {
  std::string geometry;  ///< the CAD file; empty: left to the user
  bool every_key = false;
  std::string schema;  ///< path of the schema, relative to the case; empty: no reference to a schema
};

/// YAML that read_case() accepts once `geometry.file` is set. Each key is commented out at its default or an
/// example. Its text, accepted values and default stand beside it.
std::string case_template(const std::vector<KeyInfo>& keys, const TemplateRequest& request);

}  // namespace aeroloom::cases
