#include "io/distinct_names.hpp"

#include <fmt/format.h>

namespace aeroloom::io {

std::string cut_name(const std::string& name, std::size_t bytes) {
  if (name.size() <= bytes) return name;
  std::size_t end = bytes;
  while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0U) == 0x80U) --end;
  return name.substr(0, end == 0 ? bytes : end);
}

std::string TakenNames::take(const std::string& key,
                             const std::function<std::string(const std::string&)>& spell) {
  std::string result = spell("");
  while (!reserve(result)) result = spell(fmt::format("_{}", ++_numbers.try_emplace(key, 1).first->second));
  return result;
}

std::vector<std::string> distinct_names(std::span<const std::string> names, std::size_t longest,
                                        const std::function<std::string(const std::string&)>& fit,
                                        std::span<const std::string_view> reserved) {
  TakenNames taken;
  for (const std::string_view name : reserved) taken.reserve(std::string(name));
  std::vector<std::string> result(names.size());
  std::vector<std::size_t> changed;
  for (std::size_t i = 0; i < names.size(); ++i) {
    result[i] = cut_name(fit(names[i]), longest);
    if (result[i] != names[i] || !taken.reserve(result[i])) changed.push_back(i);
  }
  // Names that stay as they are have gone first, lest a renamed one takes their place.
  for (const std::size_t i : changed) {
    result[i] = taken.take(result[i], [&, wanted = result[i]](const std::string& number) {
      return cut_name(wanted, longest - number.size()) + number;
    });
  }
  return result;
}

}  // namespace aeroloom::io
