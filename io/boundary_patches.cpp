#include "io/boundary_patches.hpp"

#include <map>
#include <set>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

bool is_allowed(char c, const NameRule& rule) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte >= '0' && byte <= '9') || (byte >= 'A' && byte <= 'Z') || (byte >= 'a' && byte <= 'z') ||
         byte >= 0x80 || rule.signs.find(c) != std::string_view::npos;
}

/// The beginning of a text, not ending within a character.
std::string cut(const std::string& text, std::size_t most_bytes) {
  if (text.size() <= most_bytes) return text;
  std::size_t length = most_bytes;
  while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0U) == 0x80U) --length;
  return text.substr(0, length);
}

std::string plain_name(const std::string& name, const NameRule& rule) {
  std::string plain = name;
  for (char& c : plain) {
    if (!is_allowed(c, rule)) c = '_';
  }
  plain = cut(plain, rule.most_bytes);
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
  std::set<std::string> taken;
  for (const std::string_view reserved : rule.reserved) taken.emplace(reserved);
  // Those that stay as they are go first, lest a renamed one takes their place.
  std::vector<std::string> result(names.size());
  std::vector<std::size_t> others;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string plain = plain_name(names[i], rule);
    if (plain == names[i] && taken.insert(plain).second) {
      result[i] = plain;
    } else {
      others.push_back(i);
    }
  }
  std::map<std::string, int> last;  // number that a name has been given
  for (const std::size_t i : others) {
    const std::string plain = plain_name(names[i], rule);
    int& n = last.try_emplace(plain, 1).first->second;
    std::string candidate = plain;
    while (!taken.insert(candidate).second) {
      const std::string ending = fmt::format("_{}", ++n);
      candidate = fmt::format("{}{}", cut(plain, rule.most_bytes - ending.size()), ending);
    }
    result[i] = candidate;
  }
  return result;
}

}  // namespace aeroloom::io
