#include "cad/repair/opening_rules.hpp"

#include "cad/model/model.hpp"

#include <algorithm>
#include <array>
#include <sstream>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// The box of a text of numbers; nothing if the text is a name.
std::optional<geometry::Box> box_in(const std::string& text, double unit) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  std::vector<double> numbers;
  for (double number = 0; stream >> number;) numbers.push_back(number / unit);
  if (!stream.eof() || numbers.size() < 2) return std::nullopt;
  if (numbers.size() == 6) {
    const geometry::Vec3 low{numbers[0], numbers[1], numbers[2]}, high{numbers[3], numbers[4], numbers[5]};
    if (low.x <= high.x && low.y <= high.y && low.z <= high.z) return geometry::Box{low, high};
  }
  throw CadError(fmt::format(
      "DomainOptions::close: '{}' is no box: its lower and its upper corner are six numbers", text));
}

}  // namespace

OpeningRules::OpeningRules(const std::vector<std::string>& texts, double unit) {
  _refuse = std::ranges::find(texts, "refuse") != texts.end();
  if (_refuse && texts.size() > 1)
    throw CadError("DomainOptions::close: 'refuse' stands alone, for it closes nothing");
  if (_refuse) return;
  for (const std::string& text : texts) _entries.push_back({text, NamePattern(text), box_in(text, unit)});
}

bool OpeningRules::take(const std::vector<std::string>& names, const geometry::Box& box) {
  bool taken = false;
  for (Entry& entry : _entries) {
    const bool own =
        entry.box ? entry.box->contains(box) : std::ranges::any_of(names, [&](const std::string& name) {
          return entry.pattern.matches(name);
        });
    entry.used = entry.used || own;
    taken = taken || own;
  }
  return taken;
}

void OpeningRules::require_use() const {
  for (const Entry& entry : _entries) {
    if (entry.used) continue;
    throw CadError(fmt::format(
        "DomainOptions::close: '{}' is beside no opening that is left, and contains none. Remedy: "
        "`aeroloom info FILE` lists names; boxes are in the unit of the geometry",
        entry.text));
  }
}

}  // namespace aeroloom::cad
