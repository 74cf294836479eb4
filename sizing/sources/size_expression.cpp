#include "sizing/sources/size_expression.hpp"

#include "geometry/place_text.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>
#include <muParser.h>

namespace aeroloom::sizing {

struct SizeExpression::Parsed {
  std::string text;
  geometry::Vec3 place;
  mu::Parser parser;
};

namespace {

/// muparser takes `x = 1` for an assignment.
bool assigns(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    if (i + 1 < text.size() && text[i + 1] == '=') {
      ++i;
    } else if (i == 0 || std::string("<>!").find(text[i - 1]) == std::string::npos) {
      return true;
    }
  }
  return false;
}

}  // namespace

SizeExpression::SizeExpression(const std::string& text) : _parsed(std::make_shared<Parsed>()) {
  mu::Parser& parser = _parsed->parser;
  _parsed->text = text;
  try {
    parser.DefineVar("x", &_parsed->place.x);
    parser.DefineVar("y", &_parsed->place.y);
    parser.DefineVar("z", &_parsed->place.z);
    parser.DefineConst("pi", std::numbers::pi);
    parser.SetExpr(text);
    int results = 0;
    parser.Eval(results);  // parses
    if (results != 1) throw std::invalid_argument(fmt::format("expected one value, got {}", results));
  } catch (const mu::ParserError& error) {
    std::string message = error.GetMsg();
    if (!message.empty() && message.back() == '.') message.pop_back();
    throw std::invalid_argument(message);
  }
  if (assigns(text)) throw std::invalid_argument("x, y and z cannot be assigned to; == compares");
}

double SizeExpression::operator()(geometry::Vec3 place) const {
  _parsed->place = place;
  double size = 0;
  try {
    size = _parsed->parser.Eval();
  } catch (const mu::ParserError& error) {  // of functions that refuse a value
    throw std::runtime_error(
        fmt::format("sizing.expression at {}: {}", geometry::place_text(place), error.GetMsg()));
  }
  if (size > 0 && std::isfinite(size)) return size;
  throw std::runtime_error(
      fmt::format("sizing.expression is {:.6g} at {}, but a size must be positive and finite in the whole "
                  "domain, inside of bodies too. Remedy: max(..., a smallest size)",
                  size, geometry::place_text(place)));
}

const std::string& SizeExpression::text() const {
  return _parsed->text;
}

std::string muparser_version() {
  return mu::ParserVersion.substr(0, mu::ParserVersion.find(' '));
}

}  // namespace aeroloom::sizing
