#include "io/distinct_names.hpp"

#include <unordered_map>
#include <unordered_set>

namespace aeroloom::io {

namespace {

/// At most `longest` bytes, no character cut in two.
std::string cut(const std::string& name, std::size_t longest) {
  if (name.size() <= longest) return name;
  std::size_t end = longest;
  while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0U) == 0x80U) --end;
  return name.substr(0, end);
}

}  // namespace

std::vector<std::string> distinct_names(std::span<const std::string> names, std::size_t longest,
                                        const std::function<std::string(const std::string&)>& fit) {
  std::vector<std::string> result(names.size());
  std::unordered_set<std::string> taken;
  std::vector<std::size_t> changed;
  for (std::size_t i = 0; i < names.size(); ++i) {
    result[i] = cut(fit(names[i]), longest);
    if (result[i] != names[i] || !taken.insert(result[i]).second) changed.push_back(i);
  }
  std::unordered_map<std::string, int> next;  // so that many equal names take no time
  for (const std::size_t i : changed) {
    const std::string wanted = result[i];
    while (!taken.insert(result[i]).second) {
      const std::string ending = "_" + std::to_string(++next.try_emplace(wanted, 1).first->second);
      result[i] = cut(wanted, longest - ending.size()) + ending;
    }
  }
  return result;
}

}  // namespace aeroloom::io
