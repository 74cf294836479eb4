/// A size as a formula of the place.
#pragma once

#include "geometry/vec.hpp"

#include <memory>
#include <string>

namespace aeroloom::sizing {

/// h(x, y, z) as muparser reads it: + - * / ^, comparisons, && || and a ? b : c, the functions of mathematics
/// (sqrt, exp, ln, sin, abs, min, max, ...), pi. Cheap to copy; copies share what was parsed, so they belong
/// to one thread.
class SizeExpression {
public:
  /// Throws std::invalid_argument with the symbol and its position where that is no formula of x, y and z.
  explicit SizeExpression(const std::string& text);

  /// The value, in the model's unit of length. Throws std::runtime_error, naming the place, unless it is
  /// positive and finite.
  double operator()(geometry::Vec3 place) const;
  const std::string& text() const;

private:
  struct Parsed;
  std::shared_ptr<Parsed> _parsed;
};

/// Of muparser, as it was compiled against.
std::string muparser_version();

}  // namespace aeroloom::sizing
