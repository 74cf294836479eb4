/// What pieces contribute to the figures of mesh/quality/solver_quality.hpp.
#pragma once

#include "mesh/quality/solver_quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace aeroloom::mesh {

inline constexpr double none_yet = std::numeric_limits<double>::infinity();
/// Of severe_non_orthogonality.
inline const double severe_cosine = std::cos(severe_non_orthogonality * std::numbers::pi / 180);

/// The inner faces of one class in one piece.
struct ClassSums {
  GlobalIndex faces = 0, non_orthogonal = 0, high_ratios = 0, severe_ratios = 0;
  double cosines = 0, least_cosine = none_yet;
  double fractions = 0, least_fraction = none_yet;

  void add(double cosine, double fraction) {
    ++faces;
    cosines += cosine;
    fractions += fraction;
    least_cosine = std::min(least_cosine, cosine);
    least_fraction = std::min(least_fraction, fraction);
    if (cosine < severe_cosine) ++non_orthogonal;
    if (high_volume_ratio * fraction < 1) ++high_ratios;
    if (severe_volume_ratio * fraction < 1) ++severe_ratios;
  }
  void add(const ClassSums& other) {
    faces += other.faces, non_orthogonal += other.non_orthogonal;
    high_ratios += other.high_ratios, severe_ratios += other.severe_ratios;
    cosines += other.cosines, fractions += other.fractions;
    least_cosine = std::min(least_cosine, other.least_cosine);
    least_fraction = std::min(least_fraction, other.least_fraction);
  }
};

/// The figures of one piece. Skewness and aspect ratios below what counts, and better than ten places of the
/// same rank, need not be added.
struct PieceSums {
  std::array<ClassSums, face_class_count> of_class;
  GlobalIndex cells = 0, boundary_faces = 0, skewed = 0, stretched = 0, underdetermined = 0;
  double largest_skewness = 0, largest_aspect_ratio = 0;
  double determinants = 0, least_determinant = none_yet;

  void add_skewness(double value) {
    largest_skewness = std::max(largest_skewness, value);
    if (value > severe_skewness) ++skewed;
  }
  void add_aspect_ratio(double value) {
    largest_aspect_ratio = std::max(largest_aspect_ratio, value);
    if (value > severe_aspect_ratio) ++stretched;
  }
  void add_determinant(double value) {
    ++cells;
    determinants += value;
    least_determinant = std::min(least_determinant, value);
    if (value < severe_determinant) ++underdetermined;
  }
  void add(const PieceSums& other) {
    for (std::size_t c = 0; c < face_class_count; ++c) of_class[c].add(other.of_class[c]);
    cells += other.cells, boundary_faces += other.boundary_faces;
    skewed += other.skewed, stretched += other.stretched, underdetermined += other.underdetermined;
    largest_skewness = std::max(largest_skewness, other.largest_skewness);
    largest_aspect_ratio = std::max(largest_aspect_ratio, other.largest_aspect_ratio);
    determinants += other.determinants;
    least_determinant = std::min(least_determinant, other.least_determinant);
  }
};

/// Of all pieces.
SolverQuality summarise(const PieceSums& sum);

}  // namespace aeroloom::mesh
