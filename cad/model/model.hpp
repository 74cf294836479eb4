/// The CAD model: topology as numbers (ids), evaluation, projection, triangulation. No OpenCASCADE type is
/// visible.
///
/// Lengths are in the model's unit, which is the unit that the file declares (BREP: as stored). Angles are in
/// radians. A model is immutable. Every rank builds its own from the same bytes, so ids are the same
/// everywhere.
#pragma once

#include "cad/model/evaluation/face_place.hpp"
#include "geometry/vec.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace aeroloom::cad {

using geometry::Box;
using geometry::Vec2;
using geometry::Vec3;

using VertexId = std::int32_t;
using EdgeId = std::int32_t;
using FaceId = std::int32_t;
using RegionId = std::int32_t;
inline constexpr std::int32_t no_entity = -1;

/// Any defect of CAD input. The message names file, entity, place and remedy.
class CadError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// A coedge: one use of an edge in a loop. A face that is closed uses its seam twice, as use 0 and use 1.
struct Coedge {
  EdgeId edge = no_entity;
  std::int32_t use = 0;
  bool reversed = false;  ///< the loop runs against the edge's parameter
};

struct Edge {
  VertexId first = no_entity,
           last = no_entity;  ///< at first_parameter and last_parameter; equal for a closed edge
  double first_parameter = 0, last_parameter = 0;
  bool degenerate = false;    ///< collapsed to a point in space (a pole); first == last
  std::vector<FaceId> faces;  ///< all faces that use the edge, ascending, each once
};

struct Face {
  std::vector<std::vector<Coedge>> loops;  ///< material on the left, seen against the outward normal
  std::int32_t patch = 0;                  ///< index into patches()
  /// As in the file; if it gives none, "face_<number>" with the number in the file, from 0.
  std::string name;
  /// As in the file, for the face or what contains it. Empty if there is none.
  std::string part, layer, colour;  ///< part: solid or product; colour: "#rrggbb"
  std::int32_t number = -1;         ///< in the file, from 0; -1 if the program made the face
  /// Regions on the inner and the outer side of the oriented face; `back` is no_entity on the boundary of the
  /// domain. A baffle has one region on both sides.
  RegionId front = no_entity, back = no_entity;
};

/// A point of a face with derivatives and normal.
struct SurfaceFrame {
  Vec3 point;
  Vec3 du, dv;  ///< first derivatives
  Vec3 normal;  ///< unit, out of the region `front`; zero at singular points
};

struct PrincipalCurvatures {
  double largest = 0, smallest = 0;  ///< absolute values, 1/length
  bool defined = false;              ///< false at singular points
};

struct CurvedPoint {
  Vec3 point;
  PrincipalCurvatures curvatures;
};

/// The projection of a point onto a face.
struct Projection {
  Vec2 uv;
  Vec3 point;
  bool converged = false;
};

/// A triangulation of one face; see Model::facets().
struct Facets {
  /// The nodes along one coedge, in the direction of the edge's parameter.
  struct BoundaryLine {
    Coedge use;
    std::vector<std::int32_t> nodes;
    std::vector<double> parameters;  ///< on the edge, ascending, one per node
  };
  std::vector<Vec3> points;
  std::vector<Vec2> uv;  ///< per point; points on a seam or pole occur once per coedge
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< counter-clockwise seen against the outward normal
  std::vector<BoundaryLine> boundary;                  ///< one per coedge of the face
};

/// The CAD model of the domain to mesh. Immutable.
class Model {
public:
  /// Rebuilds a model from the bytes of serialise(). Throws CadError.
  static Model from_bytes(std::span<const std::byte> bytes);
  /// The model as bytes: geometry, topology, labels, unit.
  std::vector<std::byte> serialise() const;

  std::int32_t vertex_count() const;
  std::int32_t edge_count() const;
  std::int32_t face_count() const;
  std::int32_t region_count() const;
  Vec3 vertex(VertexId id) const;
  const Edge& edge(EdgeId id) const;
  const Face& face(FaceId id) const;
  const std::string& region_name(RegionId id) const;
  /// Names of the boundary patches. Faces with the same name share one.
  const std::vector<std::string>& patches() const;
  /// The box of all faces, far field included.
  const Box& bounds() const;
  /// The box of the faces that are not far field; equal to bounds() if all or none are.
  const Box& body_bounds() const;
  /// Whether the face belongs to the far field that the program added. Sizing gives it the size `maximum`.
  bool is_far_field(FaceId id) const;
  /// Name of the declared unit ("m", "mm", "in", "ft", ...), empty if there is none, and its length in
  /// metres.
  const std::string& unit_name() const;
  double unit_in_metres() const;
  /// Width of the widest gap that sewing closed; surfaces and edges may be that far apart. 0 without sewing.
  double sewn_gap() const;

  /// Point, derivative and curvature of the edge. Not for degenerate edges.
  Vec3 edge_point(EdgeId id, double parameter) const;
  Vec3 edge_tangent(EdgeId id, double parameter) const;      ///< first derivative
  double edge_curvature(EdgeId id, double parameter) const;  ///< 1/length; 0 on lines and if undefined
  /// Parameters of the edge's point on a face that uses it.
  Vec2 edge_uv(FaceId face, const Coedge& use, double parameter) const;
  /// The parameter interval, split where the curve is not smooth (C1). Ends included, ascending.
  std::vector<double> edge_breaks(EdgeId id) const;

  Vec3 face_point(FaceId id, Vec2 uv) const;
  SurfaceFrame face_frame(FaceId id, Vec2 uv) const;
  PrincipalCurvatures face_curvatures(FaceId id, Vec2 uv) const;
  /// face_point() and face_curvatures() together, with one evaluation.
  CurvedPoint face_curved_point(FaceId id, Vec2 uv) const;
  bool is_planar(FaceId id) const;
  /// Whether the face is an axis-aligned plane whose points have its coordinate exactly.
  bool is_exact_plane(FaceId id) const;
  /// Whether the face consists of flat triangles from a file (STL and the like). Its surface is exactly these
  /// triangles; its edges are chains of their sides.
  bool is_faceted(FaceId id) const;
  /// Number of sheets of the parameter plane. Each is the parameter plane of one CAD face, or of a part of a
  /// faceted face. There are several in joined faces (joined_faces.hpp).
  std::int32_t sheet_count(FaceId id) const;
  /// Ids of the joined faces in the model before joining; the face itself if it is not joined.
  std::vector<FaceId> members(FaceId id) const;
  /// The sheet of a point in the parameter plane. Do not interpolate between sheets.
  std::int32_t sheet(FaceId id, Vec2 uv) const;
  /// Whether one face uses the edge twice and no other face uses it. Such an edge constrains nothing.
  bool is_seam(EdgeId id) const;
  /// Periods of the parameters u and v at a point; 0 if there is none. For joined faces, those of the sheet.
  Vec2 parameter_periods(FaceId id, Vec2 uv) const;
  /// Parameters of the same point inside the range of the surface.
  Vec2 wrap(FaceId id, Vec2 uv) const;
  /// The nearest point of the face's surface, by Newton's method from `guess`. A good guess makes it fast.
  /// Stays within the parameter range; periodic directions wrap. If it does not converge, returns the best
  /// point found with converged = false.
  Projection project(FaceId id, Vec3 point, Vec2 guess) const;
  /// Area by adaptive Gauss integration, relative error about 1e-4. Computed once.
  double face_area(FaceId id) const;
  /// Integral of the normal out of `front` over the face, as accurate as the area. Computed once. Not for
  /// joined faces.
  Vec3 face_area_vector(FaceId id) const;
  /// Volume of the exact geometry, as accurate as the areas.
  double region_volume(RegionId id) const;
  /// Area, centre and box of the face. Computed at each call.
  FacePlace face_place(FaceId id) const;

  /// Triangulates a face. Neighbouring triangles turn by at most `angle` (radians) and lie within
  /// `deflection` of the surface. The result depends on the face and the arguments alone. With Keep::yes it
  /// is kept for calls with the same arguments, one triangulation per face. Throws CadError that names the
  /// face if the CAD library fails.
  enum class Keep : bool { no, yes };
  Facets facets(FaceId id, double deflection, double angle, Keep keep = Keep::no) const;

  struct Data;  ///< implementation, hidden outside cad/
  explicit Model(std::shared_ptr<const Data> data) : _data(std::move(data)) {}
  const Data& data() const { return *_data; }

private:
  std::shared_ptr<const Data> _data;
};

}  // namespace aeroloom::cad
