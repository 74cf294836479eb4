#include "cad/read/input_files.hpp"

#include "cad/faceted/facet_soup.hpp"

namespace aeroloom::cad {

std::vector<std::string> input_files_of(const DomainOptions& options) {
  std::vector<std::string> files;
  const auto add = [&](const std::string& file) {
    files.push_back(file);
    if (std::optional<std::string> points = points_beside(file)) files.push_back(std::move(*points));
  };
  if (!options.file.empty()) add(options.file);
  for (const FacetedBody& part : options.parts) add(part.file);
  return files;
}

}  // namespace aeroloom::cad
