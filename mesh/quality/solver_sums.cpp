#include "mesh/quality/solver_sums.hpp"

#include "mesh/quality/cell_measures.hpp"
#include "mesh/quality/face_measures.hpp"

namespace aeroloom::mesh {

namespace {

double mean_of(double sum, GlobalIndex count) {
  return sum / static_cast<double>(count);
}

FacesOfClass summarise(const ClassSums& sums) {
  FacesOfClass result;
  if (sums.faces == 0) return result;
  result.faces = sums.faces;
  result.largest_non_orthogonality = degrees_of_cosine(sums.least_cosine);
  result.average_non_orthogonality = degrees_of_cosine(mean_of(sums.cosines, sums.faces));
  result.non_orthogonal_faces = sums.non_orthogonal;
  result.largest_volume_ratio =
      sums.least_fraction * largest_ratio > 1 ? 1 / sums.least_fraction : largest_ratio;
  result.high_volume_ratios = sums.high_ratios, result.severe_volume_ratios = sums.severe_ratios;
  return result;
}

}  // namespace

SolverQuality summarise(const PieceSums& sum) {
  SolverQuality result;
  ClassSums all;
  for (std::size_t c = 0; c < face_class_count; ++c) {
    all.add(sum.of_class[c]);
    result.of_class[c] = summarise(sum.of_class[c]);
  }
  const FacesOfClass inner = summarise(all);
  result.cells = sum.cells, result.inner_faces = inner.faces, result.boundary_faces = sum.boundary_faces;
  result.largest_non_orthogonality = inner.largest_non_orthogonality;
  result.average_non_orthogonality = inner.average_non_orthogonality;
  result.non_orthogonal_faces = inner.non_orthogonal_faces;
  result.largest_skewness = sum.largest_skewness, result.skewed_faces = sum.skewed;
  result.largest_aspect_ratio = sum.largest_aspect_ratio, result.stretched_cells = sum.stretched;
  result.underdetermined_cells = sum.underdetermined;
  if (sum.cells > 0) {
    result.smallest_determinant = sum.least_determinant;
    result.mean_determinant = mean_of(sum.determinants, sum.cells);
  }
  if (all.faces > 0) {
    result.smallest_volume_ratio = all.least_fraction;
    result.mean_volume_ratio = mean_of(all.fractions, all.faces);
  }
  return result;
}

}  // namespace aeroloom::mesh
