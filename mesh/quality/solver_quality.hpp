/// How good a mesh of several shapes is for solvers with unknowns at the centres of cells.
#pragma once

#include "mesh/quality/face_links.hpp"
#include "mesh/quality/worst_places.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace aeroloom::mesh {

/// Defined in mesh/quality/face_measures.hpp.
enum class SolverMeasure : std::uint8_t {
  non_orthogonality,  ///< of inner faces, degrees
  skewness,           ///< of all faces
  aspect_ratio,       ///< of cells
  determinant,        ///< of cells
  volume_ratio,       ///< of inner faces: smaller over larger volume
};
inline constexpr std::size_t solver_measure_count = 5;
inline constexpr std::array<SolverMeasure, solver_measure_count> all_solver_measures = {
    SolverMeasure::non_orthogonality, SolverMeasure::skewness, SolverMeasure::aspect_ratio,
    SolverMeasure::determinant, SolverMeasure::volume_ratio};
/// As keys of reports have it.
std::string_view name_of(SolverMeasure measure);
/// Whether larger values are the worse ones.
inline constexpr bool larger_is_worse(SolverMeasure measure) {
  return measure <= SolverMeasure::aspect_ratio;
}

/// Beyond these values faces and cells are counted, as checkMesh does.
inline constexpr double severe_non_orthogonality = 70, severe_skewness = 4, severe_aspect_ratio = 1000,
                        severe_determinant = 0.001;
/// Larger over smaller volume, at faces by class.
inline constexpr double high_volume_ratio = 10, severe_volume_ratio = 30;

/// Inner faces by the cells on both sides.
enum class FaceClass : std::uint8_t { within_layers, at_front, off_layers };
inline constexpr std::size_t face_class_count = 3;
inline constexpr std::array<FaceClass, face_class_count> all_face_classes = {
    FaceClass::within_layers, FaceClass::at_front, FaceClass::off_layers};
/// As keys of reports have it.
std::string_view name_of(FaceClass face_class);

/// The inner faces of one class; zero where there are none.
struct FacesOfClass {
  GlobalIndex faces = 0;
  /// Degrees; the average is the angle of the mean cosine.
  double largest_non_orthogonality = 0, average_non_orthogonality = 0;
  GlobalIndex non_orthogonal_faces = 0;  ///< above severe_non_orthogonality
  /// Larger over smaller volume; mesh::largest_ratio where one is not above zero.
  double largest_volume_ratio = 0;
  GlobalIndex high_volume_ratios = 0, severe_volume_ratios = 0;  ///< those above the bounds with these names
};

/// Zero where there are no such faces or cells.
struct SolverQuality {
  GlobalIndex cells = 0, inner_faces = 0, boundary_faces = 0;
  double largest_non_orthogonality = 0, average_non_orthogonality = 0;  ///< degrees, as in FacesOfClass
  GlobalIndex non_orthogonal_faces = 0;                                 ///< above severe_non_orthogonality
  double largest_skewness = 0;                                          ///< of inner and boundary faces
  GlobalIndex skewed_faces = 0;                                         ///< above severe_skewness
  double largest_aspect_ratio = 0;
  GlobalIndex stretched_cells = 0;  ///< above severe_aspect_ratio
  double smallest_determinant = 0, mean_determinant = 0;
  GlobalIndex underdetermined_cells = 0;                    ///< below severe_determinant
  double smallest_volume_ratio = 0, mean_volume_ratio = 0;  ///< smaller over larger
  /// The ten worst by SolverMeasure, worst first, ties by number; of each cell its worst face. The number is
  /// the lower one of both cells at a face, the centre that of the face or of the cell.
  std::array<std::vector<WorstCellOfShape>, solver_measure_count> worst;
  std::array<FacesOfClass, face_class_count> of_class;

  const std::vector<WorstCellOfShape>& worst_of(SolverMeasure measure) const {
    return worst[static_cast<std::size_t>(measure)];
  }
  const FacesOfClass& faces_of(FaceClass face_class) const {
    return of_class[static_cast<std::size_t>(face_class)];
  }
};

/// A face is an inner one where it has cells on both sides: between regions, and on baffles too. Cells of
/// layers are those with a positive number in Piece::layers; where no piece has such numbers, as in files,
/// all but tetrahedra. Takes 32 bytes a cell. `links` are those of the mesh. Collective; the same on every
/// rank and for any number of ranks (sums are taken in the order of pieces).
SolverQuality measure_as_solvers(const NumberedMesh& mesh, const FaceLinks& links);

/// Adds the flaws of faces to the worst places.
void add_faces(const SolverQuality& quality, WorstPlaces& places);

}  // namespace aeroloom::mesh
