/// The pictures of a report.
///
/// `body`: what is shown, by patch; `views`: from above, from the side, from the front, and from behind and
/// below; `leading_edge` and `junction`: single triangles at two places that
/// pipeline/report/picture/places.hpp finds, left out where it finds none; `cut`: the tetrahedra that a plane
/// cuts; `leading_edge_cut`: those across the leading edge. What is shown is the body in the flow, or else
/// the walls of the flow, seen from inside (pipeline/report/picture/scene.hpp). The flow comes along x, and z
/// is up. The plane of the cut is that of symmetry for half a body, the middle of a whole one across y, and
/// the middle of a duct across its shortest extent.
///
/// All ranks draw what they hold; nothing is gathered but pictures and lines on the surface. A rank needs 32
/// bytes for each of at most 0.7 million pixels and 200 for each triangle of the surface. A picture has as
/// many colours, at most 256, as keep it below 240 kB.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "parallel/communication/communicator.hpp"
#include "pipeline/case/case.hpp"
#include "pipeline/report/exit_code.hpp"
#include "pipeline/report/picture.hpp"

#include <string>
#include <vector>

namespace aeroloom::report {

/// The meshes and names that pictures are made of.
struct PictureSource {
  const mesh::NumberedMesh& surface;  ///< the boundary of the domain
  const std::vector<mesh::PatchType>& types;
  std::string unit;  ///< of lengths, may be empty
};

/// Pictures of the volume, or of the surface alone where `volume` is null, on rank 0, the same bytes for any
/// number of ranks; nothing elsewhere. A failure is a warning, and there are no pictures. Collective.
std::vector<Picture> pictures_or_warning(const parallel::Communicator& communicator,
                                         const mesh::DistributedMesh* volume, const PictureSource& source);

/// Runs `work` and returns its result. Should the volume fail there, the surface alone is pictured before the
/// failure goes on, if the output is to have pictures. Collective.
template <class Work>
auto with_pictures_of_failure(const parallel::Communicator& communicator, const PictureSource& source,
                              const cases::OutputOptions& output, std::vector<Picture>& pictures, Work work) {
  try {
    return work();
  } catch (const StageFailure& failure) {
    if (output.pictures && failure.code() == ExitCode::volume)
      pictures = pictures_or_warning(communicator, nullptr, source);
    throw;
  }
}

}  // namespace aeroloom::report
