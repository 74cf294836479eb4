/// What the parser takes and refuses, for comparison with the schema: for every key and section
/// values inside and outside of what it accepts. Prints lines "yes CASE" and "no CASE", each case YAML in one
/// line. Values in quotes that look like numbers, and words for true and false, are left out: there the
/// schema is stricter on purpose.
#include "pipeline/case/case.hpp"
#include "pipeline/case/key_info.hpp"

#include <cmath>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

using namespace aeroloom;

namespace {

std::vector<std::string> numbers(const cases::KeyInfo& key) {
  std::vector<std::string> values = {"abc", "1 m", "[1]", "{a: 1}", "true", "",
                                     "0",   "1",   "-1",  "2.5",    "0.25"};
  const double infinity = std::numeric_limits<double>::infinity();
  const auto round = [&](double limit) {
    if (!std::isfinite(limit)) return;
    const double by = key.kind == cases::KeyKind::integer ? 1 : 0;
    for (const double value : {limit, by > 0 ? limit - by : std::nextafter(limit, -infinity),
                               by > 0 ? limit + by : std::nextafter(limit, infinity), limit - 0.5,
                               limit + 0.5, 10 * limit + 1, -10 * limit - 1})
      values.push_back(cases::shortest(value));
  };
  round(key.range.low);
  round(key.range.high);
  values.insert(values.end(), key.choices.begin(), key.choices.end());
  return values;
}

std::vector<std::string> values_of(const cases::KeyInfo& key) {
  switch (key.kind) {
    case cases::KeyKind::section:
    case cases::KeyKind::named:
      return {"", "{}", "5", "abc", "[a]", "{no_such_key: 1}"};
    case cases::KeyKind::number:
    case cases::KeyKind::integer:
      return numbers(key);
    case cases::KeyKind::flag:
      return {"true", "false", "3", "abc", "", "[true]", "{a: 1}"};
    case cases::KeyKind::text:
      return {"abc", "5", "''", "", "[a]", "{a: 1}"};
    case cases::KeyKind::texts:
      return {"abc", "5", "[a, b]", "[a, 7]", "[]", "", "[[a]]", "[{a: 1}]", "['']", "''", "{a: 1}", "[~]"};
    case cases::KeyKind::point:
      return {"[0, 1, 2]", "[0.5, -1e3, 2]", "[1, 2]",      "[1, 2, 3, 4]", "[a, 1, 2]", "5",
              "",          "[~, 1, 2]",      "[[1, 2, 3]]", "{a: 1}",       "[]",        "abc"};
    case cases::KeyKind::direction:
      return {"[0, 1, 2]", "[1, 0]", "[1, 0, a]", "5", "", "x", "{a: 1}", "[[1, 0, 0]]"};
    case cases::KeyKind::interval:
      return {"[0, 1]", "[-1.5, 1e9]", "[2]", "[0, 1, 2]", "[a, 1]", "5", "", "{a: 1}", "[[0, 1]]", "[~, 1]"};
    case cases::KeyKind::box:
      return {"[[0, 0, 0], [1, 1, 1]]",
              "[[1, 2, 3], [0, 0, -1e3]]",
              "[[0, 0, 0]]",
              "[0, 1]",
              "[[0, 0], [1, 1]]",
              "[[0, 0, 0], [1, 1, a]]",
              "5",
              "",
              "{a: 1}",
              "[0, 0, 0]"};
    case cases::KeyKind::sections: {
      const std::string one = key.of_each.front().path + ": abc";
      return {"[{" + one + "}]",
              "[{}]",
              "[{" + one + "}, {" + one + "}]",
              "[{no_such_key: 1}]",
              "[]",
              "",
              "5",
              "{" + one + "}",
              "[5]",
              "[~]",
              "[[{" + one + "}]]"};
    }
    case cases::KeyKind::choice:
    case cases::KeyKind::choices:
      break;
  }
  std::vector<std::string> values = key.choices;
  for (const char* const other : {"no_such_name", "", "''", "5", "{a: 1}", "[]", "[no_such_name]", "[~]"})
    values.emplace_back(other);
  const std::string& first = key.choices.front();
  for (const std::string& list : {first, first + ", " + key.choices.back(), first + ", no_such_name"})
    values.push_back(std::string("[").append(list).append("]"));
  return values;
}

/// "{a: {b: value}}" of "a.b".
std::string case_with(const std::string& path, const std::string& value) {
  std::string text = value;
  for (std::size_t end = path.size(); end != std::string::npos && end > 0;) {
    const std::size_t dot = path.rfind('.', end - 1);
    const std::size_t start = dot == std::string::npos ? 0 : dot + 1;
    text = std::string("{").append(path, start, end - start).append(": ").append(text).append("}");
    end = dot;
  }
  return text;
}

void tell(const std::string& path, const std::string& value) {
  bool taken = true;
  try {
    cases::case_of_overrides({path + "=" + value});
  } catch (const cases::CaseError&) {
    taken = false;
  }
  std::cout << (taken ? "yes " : "no ") << case_with(path, value) << "\n";
}

}  // namespace

int main() {
  tell("no_such_section", "{}");
  for (const cases::KeyInfo& key : cases::case_keys()) {
    for (const std::string& value : values_of(key)) tell(key.path, value);
  }
  return 0;
}
