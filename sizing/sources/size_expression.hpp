/// A size as a formula of the place.
#pragma once

#include "geometry/vec.hpp"

#include <memory>
#include <string>

namespace aeroloom::sizing {

/// A formula h(x, y, z), read by muparser. It knows + - * / ^, comparisons, && ||, a ? b : c, pi and
/// functions (sqrt, exp, ln, sin, abs, min, max, ...). Cheap to copy. Copies share the parsed formula, so all
/// must be used in one thread.
class SizeExpression {
public:
  /// Throws std::invalid_argument, with the symbol and its position, if the text is no formula of x, y and z.
  explicit SizeExpression(const std::string& text);

  /// The value, in the unit of length of the model. Throws std::runtime_error, naming the place, if it is not
  /// positive and finite.
  double operator()(geometry::Vec3 place) const;
  const std::string& text() const;

private:
  struct Parsed;
  std::shared_ptr<Parsed> _parsed;
};

/// The version of muparser that this was compiled with.
std::string muparser_version();

}  // namespace aeroloom::sizing
