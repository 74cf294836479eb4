/// Makes the pictures of a report.
///
/// They are: `body`, the patches; `views`, from above, the side, the front and from behind; `leading_edge`
/// and `junction`, triangles at two places (picture/places.hpp), if there are such places; `cut`, the
/// tetrahedra in a plane; `leading_edge_cut`, those across the leading edge; `layers`, the number of boundary
/// layers on each triangle. Pictures show the body in the flow, or else the walls of the flow from inside
/// (picture/scene.hpp). The flow comes along x, and z is up. The cut is the symmetry plane of half a body,
/// the middle plane normal to y of a whole one, or the middle of a duct across its shortest side.
///
/// Each rank draws its pieces; only images and lines on the surface are gathered. Memory of a rank: 32 bytes
/// for each of at most 0.7 million pixels, 200 bytes for each surface triangle. A picture has up to 256
/// colours, fewer if it would exceed 240 kB.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "pipeline/case/case.hpp"
#include "pipeline/report/exit_code.hpp"
#include "pipeline/report/picture.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::report {

/// The meshes and names for pictures.
struct PictureSource {
  const mesh::NumberedMesh& surface;  ///< the boundary of the domain
  const std::vector<mesh::PatchType>& types;
  std::string unit;  ///< of lengths; may be empty
  /// By piece and triangle: the number of boundary layers, -1 where none are asked for. Empty without layers.
  std::vector<std::vector<std::int32_t>> layers = {};
};

/// The pictures on rank 0, empty elsewhere; the same bytes for any number of ranks. `volume` null: pictures
/// of the surface alone. A failure becomes a warning and gives no pictures. Collective.
std::vector<Picture> pictures_or_warning(const PictureSource& source, const mesh::DistributedMesh* volume);

/// Runs `work` and returns its result. If the volume fails there and the output has pictures, `pictures`
/// shows the surface before the exception goes on. Collective.
template <class Work>
auto with_pictures_of_failure(const PictureSource& source, const cases::OutputOptions& output,
                              std::vector<Picture>& pictures, Work work) {
  try {
    return work();
  } catch (const StageFailure& failure) {
    if (output.pictures && failure.code() == ExitCode::volume)
      pictures = pictures_or_warning(source, nullptr);
    throw;
  }
}

}  // namespace aeroloom::report
