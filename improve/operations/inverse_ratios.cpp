#include "improve/operations/inverse_ratios.hpp"

#include <bit>
#include <cstdint>

namespace aeroloom::improve {
namespace {

/// The cube root of a positive number, to 1e-14 of it (tried from 1e-12 to 1e12): a guess from the exponent,
/// within 3.3 %, and two of Halley's steps.
double cube_root(double x) {
  // Two thirds of the bits of one, less what makes the largest error of either sign the same.
  constexpr std::uint64_t two_thirds_of_one = 0x2a9f7893782da1ceULL;
  double r = std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) / 3 + two_thirds_of_one);
  for (int i = 0; i < 2; ++i) {
    const double cube = r * r * r;
    r *= (cube + 2 * x) / (2 * cube + x);
  }
  return r;
}

}  // namespace

void InverseRatios::add(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 ab = b - a, ac = c - a, bc = c - b;
  // Counter-clockwise seen from outside.
  _cones.push_back({a, ab + ac, cross(ab, ac), 2 * dot(ab, ab) + 2 * dot(ac, ac) + dot(bc, bc)});
}

double InverseRatios::operator()(Vec3 p) const {
  double sum = 0;
  for (const Cone& k : _cones) {
    const Vec3 d = p - k.a;
    const double volume6 = dot(k.normal, d);
    if (!(volume6 > 0)) return invalid;
    const double root = cube_root(0.5 * volume6);
    sum -= (k.squares + dot(d, 3 * d - 2 * k.sum)) / (12 * root * root);
  }
  return sum;
}

double InverseRatios::with_gradient(Vec3 p, Vec3& gradient) const {
  double sum = 0;
  gradient = {};
  for (const Cone& k : _cones) {
    const Vec3 d = p - k.a;
    const double volume6 = dot(k.normal, d);
    if (!(volume6 > 0)) {
      sum = invalid;
      continue;
    }
    const double root = cube_root(0.5 * volume6);
    const double squares = k.squares + dot(d, 3 * d - 2 * k.sum);
    const double each = squares / (12 * root * root);
    sum -= each;
    gradient += each * ((2 / (3 * volume6)) * k.normal - (2 / squares) * (3 * d - k.sum));
  }
  return sum;
}

}  // namespace aeroloom::improve
