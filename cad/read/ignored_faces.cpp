#include "cad/read/ignored_faces.hpp"

#include "cad/model/model.hpp"
#include "cad/model/patches.hpp"
#include "cad/model/shape_map.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

std::optional<int> number_in(const std::string& text) {
  int number = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

[[noreturn]] void refuse(const std::string& text, const char* what) {
  throw CadError(fmt::format(
      "DomainOptions::ignore: no {} of the file is called '{}'. Remedy: `aeroloom info FILE` lists "
      "them; * stands for any characters",
      what, text));
}

}  // namespace

void ignore_faces(NamedShape& named, const std::vector<std::string>& texts, Changes& changes) {
  const TopTools_IndexedMapOfShape faces = map_of(named.shape, TopAbs_FACE);
  for (const std::string& text : texts) {
    const NamePattern pattern(text);
    const std::optional<int> number = number_in(text);
    bool any = false;
    for (int i = 1; i <= faces.Extent(); ++i) {
      FaceLabel* label = named.labels.ChangeSeek(faces(i));
      if (label == nullptr) continue;
      const std::string name = shown_name(*label);
      if (!pattern.matches(name) && !(number && label->number == *number)) continue;
      any = true;
      if (label->ignored) continue;
      label->ignored = true;
      changes.push_back({fmt::format("face '{}' is left out, as the case asks", name)});
    }
    if (!any) refuse(text, "face");
  }
}

void ignore_groups(FacetSoup& soup, const std::vector<std::string>& patterns, Changes& changes) {
  if (patterns.empty()) return;
  std::vector<char> ignored(soup.groups.size(), 0);
  for (const std::string& text : patterns) {
    const NamePattern pattern(text);
    bool any = false;
    for (std::size_t g = 0; g < soup.groups.size(); ++g) {
      const FacetSoup::Group& group = soup.groups[g];
      const bool matches = (!group.name.empty() && pattern.matches(group.name)) ||
                           (!group.part.empty() && pattern.matches(group.part));
      if (matches && !ignored[g])
        changes.push_back({fmt::format("the triangles of '{}' are left out, as the case asks",
                                       group.name.empty() ? group.part : group.name)});
      if (matches) any = true, ignored[g] = 1;
    }
    if (!any) refuse(text, "group of triangles");
  }
  std::size_t kept = 0;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    if (ignored[soup.group_of[t]]) continue;
    soup.triangles[kept] = soup.triangles[t], soup.group_of[kept] = soup.group_of[t];
    ++kept;
  }
  soup.triangles.resize(kept), soup.group_of.resize(kept);
  if (kept == 0) throw CadError("DomainOptions::ignore leaves no triangles");
}

}  // namespace aeroloom::cad
