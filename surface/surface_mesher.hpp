/// The surface stage: from CAD curves and faces to a closed, conforming, oriented triangulation.
#pragma once

#include "geometry/model.hpp"
#include "mesh/distributed_mesh.hpp"
#include "parallel/communicator.hpp"
#include "parallel/timers.hpp"
#include "partition/background_surface.hpp"
#include "sizing/size_field.hpp"

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace aeroloom::surface {

/// How a surface is cut into pieces: one per CAD face, or as many as their size asks for.
enum class SurfaceDecomposition : std::int8_t { faces, pieces };

/// Divides the background mesh of a face: the part of each of its triangles, from 0. The borders between
/// parts become cuts. Must be a function of its arguments alone.
using FaceDivider =
    std::function<std::vector<std::int32_t>(geometry::FaceId, const partition::BackgroundSurface&)>;

struct SurfaceOptions {
  SurfaceDecomposition decomposition = SurfaceDecomposition::pieces;
  std::int64_t piece_triangles = 50'000;  ///< wanted triangles of a piece
  double cut_angle = 40;  ///< degrees that cuts make with each other and with feature curves at least; 0: any
  FaceDivider divider = {};   ///< cuts every face this way instead; empty: by load
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

/// An angle of a piece where cuts end.
struct CutAngle {
  geometry::FaceId face = geometry::no_entity;
  geometry::Vec3 point;
  double degrees = 0;
};

/// A corner of a CAD face below 30 degrees: the one triangle that fills it is as sharp.
struct ListedCorner {
  geometry::FaceId face = geometry::no_entity;
  geometry::Vec3 point;
  double degrees = 0;
};

struct SurfaceReport {
  std::int64_t curve_vertices = 0;
  std::int64_t pieces = 0;
  std::int64_t divided_faces = 0;           ///< CAD faces of more than one piece
  std::vector<CutAngle> cut_angles;         ///< where cuts end, by face and angle, the same on every rank
  std::vector<ListedCorner> sharp_corners;  ///< by face, the same on every rank
  std::int64_t triangles = 0;
  int mending_rounds = 0;    ///< rounds in which sizes had to fall
  double load_error_90 = 0;  ///< the relative error that 90 % of the predicted loads stay below
};

struct SurfaceMesh {
  mesh::DistributedMesh
      mesh;  ///< triangle pieces, each part of one CAD face, numbered by face; spread over ranks by load
  SurfaceReport report;
  /// The field with the sources that mending added; the volume follows this one.
  sizing::SizeField field;
};

/// Meshes the surface of the model. Collective. Throws (through parallel::agree) the same error on all ranks.
SurfaceMesh mesh_surface(const parallel::Communicator& communicator, const geometry::Model& model,
                         const sizing::SizeField& field, const SurfaceOptions& options,
                         parallel::StageClock& clock);

}  // namespace aeroloom::surface
