/// The surface stage: from CAD curves and faces to a closed, conforming, oriented triangulation.
#pragma once

#include "geometry/model.hpp"
#include "mesh/distributed_mesh.hpp"
#include "parallel/communicator.hpp"
#include "parallel/timers.hpp"
#include "sizing/size_field.hpp"

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace aeroloom::surface {

struct SurfaceOptions {
  double support_angle = 15;  ///< degrees neighbouring facets of a face's support may turn
  double chart_spread =
      60;  ///< degrees normals of one chart may spread from their axis before the chart is split
  int smoothing_sweeps = 6;  ///< of vertex smoothing and edge flips inside a face
  int mending_rounds = 6;    ///< rounds of local refinement where faces come too close, before giving up
};

/// A face that cannot be meshed. The message names the face and its patch, the place, the size there and the
/// remedy.
class SurfaceError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

struct SurfaceReport {
  std::int64_t curve_vertices = 0;
  std::int64_t triangles = 0;
  int mending_rounds = 0;    ///< rounds in which sizes had to fall
  double load_error_90 = 0;  ///< the relative error that 90 % of the predicted loads stay below
};

struct SurfaceMesh {
  mesh::DistributedMesh
      mesh;  ///< one triangle piece per CAD face, piece id = face id, spread over ranks by load
  SurfaceReport report;
  /// The field with the sources that mending added; the volume follows this one.
  sizing::SizeField field;
};

/// Meshes the surface of the model. Collective. Throws (through parallel::agree) the same error on all ranks.
SurfaceMesh mesh_surface(const parallel::Communicator& communicator, const geometry::Model& model,
                         const sizing::SizeField& field, const SurfaceOptions& options,
                         parallel::StageClock& clock);

}  // namespace aeroloom::surface
