#include "io/boundary_patches.hpp"

#include "io/distinct_names.hpp"

namespace aeroloom::io {

namespace {

bool is_allowed(char c, const NameRule& rule) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte >= '0' && byte <= '9') || (byte >= 'A' && byte <= 'Z') || (byte >= 'a' && byte <= 'z') ||
         byte >= 0x80 || rule.signs.find(c) != std::string_view::npos;
}

std::string plain_name(const std::string& name, const NameRule& rule) {
  std::string plain = name;
  for (char& c : plain) {
    if (!is_allowed(c, rule)) c = '_';
  }
  return plain.empty() ? std::string("patch") : plain;
}

}  // namespace

BoundaryPatches boundary_patches(const FileMesh& mesh) {
  BoundaryPatches result;
  result.before.push_back({});
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    const auto& faces = mesh.patch_faces[p];
    result.places.push_back(-1);
    if (mesh.patches[p].type == mesh::PatchType::interior || faces[0] + faces[1] == 0) continue;
    result.places.back() = static_cast<std::int32_t>(result.ids.size());
    result.ids.push_back(static_cast<std::int32_t>(p));
    auto next = result.before.back();
    for (std::size_t s = 0; s < next.size(); ++s) next[s] += faces[s];
    result.before.push_back(next);
  }
  return result;
}

std::vector<std::string> plain_names(std::span<const std::string> names, const NameRule& rule) {
  const auto fit = [&](const std::string& name) { return plain_name(name, rule); };
  return distinct_names(names, rule.most_bytes, fit, rule.reserved);
}

}  // namespace aeroloom::io
