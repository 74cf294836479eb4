/// The CAD model behind the project's own interface: topology as ids, evaluation, projection, facets.
///
/// Lengths are in the model's unit, which is the unit the input file declares (BREP: as stored). Angles are
/// in radians. A model is immutable; every rank builds its own from the same bytes, so ids agree everywhere.
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

/// Anything that is wrong with CAD input. The message names file, entity, place and remedy.
class CadError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// A coedge: one pass of a loop along an edge. A seam is passed twice by the same face: use 0 and use 1.
struct Coedge {
  EdgeId edge = no_entity;
  std::int32_t use = 0;
  bool reversed = false;  ///< the loop runs against the edge's parameter
};

struct Edge {
  VertexId first = no_entity,
           last = no_entity;  ///< at first_parameter and last_parameter; equal on a closed edge
  double first_parameter = 0, last_parameter = 0;
  bool degenerate = false;    ///< collapsed to a point of space (a pole); first == last
  std::vector<FaceId> faces;  ///< every face that uses it, ascending, each once
};

struct Face {
  std::vector<std::vector<Coedge>> loops;  ///< material on the left, seen against the outward normal
  std::int32_t patch = 0;                  ///< index into patches()
  /// As in the file; where it has none there, "face_<number>" with its number in the file, from 0.
  std::string name;
  /// As in the file, of the face or of what it is part of; empty where there is none.
  std::string part, layer, colour;  ///< the part (solid, product) it belongs to; of colours "#rrggbb"
  std::int32_t number = -1;         ///< in its file, from 0; -1 of what the program made
  /// Region on the inner side of the oriented face and beyond it; `back` is no_entity on the domain's
  /// boundary.
  RegionId front = no_entity, back = no_entity;
};

/// A parametric point of a face with what a mesher needs to know there.
struct SurfaceFrame {
  Vec3 point;
  Vec3 du, dv;  ///< first derivatives
  Vec3 normal;  ///< unit, out of the face's `front` region; zero where the surface is singular
};

struct PrincipalCurvatures {
  double largest = 0, smallest = 0;  ///< by absolute value, 1/length
  bool defined = false;              ///< false at singular points
};

struct CurvedPoint {
  Vec3 point;
  PrincipalCurvatures curvatures;
};

/// Where a point of space falls on a face.
struct Projection {
  Vec2 uv;
  Vec3 point;
  bool converged = false;
};

/// A triangulation of one face, fine enough to carry charts (see facets()).
struct Facets {
  /// The nodes of one coedge along an edge, in the direction of the edge's parameter.
  struct BoundaryLine {
    Coedge use;
    std::vector<std::int32_t> nodes;
    std::vector<double> parameters;  ///< on the edge, ascending, one per node
  };
  std::vector<Vec3> points;
  std::vector<Vec2> uv;  ///< per point; points on a seam or pole occur once per coedge
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< counter-clockwise seen against the outward normal
  std::vector<BoundaryLine> boundary;                  ///< one per edge use of the face
};

/// Immutable CAD model of the domain to mesh.
class Model {
public:
  /// Rebuilds the model from what serialise() wrote. Throws CadError.
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
  /// Names of the boundary patches; faces with equal names share one.
  const std::vector<std::string>& patches() const;
  /// The box of everything, far field included.
  const Box& bounds() const;
  /// The box of the faces that are not far field; equal to bounds() where there is none.
  const Box& body_bounds() const;
  /// Whether the face belongs to the far field that the program added (size `maximum` applies there).
  bool is_far_field(FaceId id) const;
  /// Unit name as declared ("m", "mm", "in", "ft", ...), empty when the file declares none, and its length in
  /// metres.
  const std::string& unit_name() const;
  double unit_in_metres() const;
  /// The widest gap between faces that sewing closed; surfaces and edges are apart by as much. 0 without
  /// sewing.
  double sewn_gap() const;

  /// Point and derivatives of the edge's curve. Not for degenerate edges.
  Vec3 edge_point(EdgeId id, double parameter) const;
  Vec3 edge_tangent(EdgeId id, double parameter) const;      ///< first derivative
  double edge_curvature(EdgeId id, double parameter) const;  ///< 1/length; 0 on a line or where undefined
  /// Parameters of the edge's point on the surface of a face that uses it.
  Vec2 edge_uv(FaceId face, const Coedge& use, double parameter) const;
  /// The parameter interval split where the curve is not smooth (C1), ends included, ascending.
  std::vector<double> edge_breaks(EdgeId id) const;

  Vec3 face_point(FaceId id, Vec2 uv) const;
  SurfaceFrame face_frame(FaceId id, Vec2 uv) const;
  PrincipalCurvatures face_curvatures(FaceId id, Vec2 uv) const;
  /// The results of face_point() and face_curvatures(), for one evaluation of the surface.
  CurvedPoint face_curved_point(FaceId id, Vec2 uv) const;
  bool is_planar(FaceId id) const;
  /// Whether the face is an axis-aligned plane, whose coordinate its points have exactly.
  bool is_exact_plane(FaceId id) const;
  /// Whether the face is made of flat triangles that a file gave (STL and the like); its surface is those
  /// triangles exactly, its edges are chains of their sides.
  bool is_faceted(FaceId id) const;
  /// CAD faces that this one consists of; more than one where narrow faces were joined (joined_faces.hpp).
  std::int32_t sheet_count(FaceId id) const;
  /// Their ids in the model before faces were joined; the face itself where none were.
  std::vector<FaceId> members(FaceId id) const;
  /// Which of them a point of the parameter plane belongs to. Between points of different sheets nothing can
  /// be interpolated.
  std::int32_t sheet(FaceId id, Vec2 uv) const;
  /// Whether one face passes the edge twice and no other face does: it constrains nothing.
  bool is_seam(EdgeId id) const;
  /// The lengths after which the surface comes back to the same points in u and v; 0 where it does not. Those
  /// of the sheet at `uv`.
  Vec2 parameter_periods(FaceId id, Vec2 uv) const;
  /// The parameters of the same point inside the surface's range, where the surface closes.
  Vec2 wrap(FaceId id, Vec2 uv) const;
  /// Nearest point of the face's surface, by Newton's method from `guess`; cheap when the guess is near.
  /// Stays within the surface's parameter range (periodic directions wrap). When it does not converge,
  /// returns the best point met with converged = false.
  Projection project(FaceId id, Vec3 point, Vec2 guess) const;
  /// Area by adaptive Gauss integration, to about 1e-4 of itself. Computed once.
  double face_area(FaceId id) const;
  /// The normal out of the face's `front` region, integrated over the face; as precise as its area. Computed
  /// once. Not for joined faces.
  Vec3 face_area_vector(FaceId id) const;
  /// Of the geometry, as precise as the areas of its faces.
  double region_volume(RegionId id) const;
  /// How large the face is, and where. Computed anew each time.
  FacePlace face_place(FaceId id) const;

  /// Triangulates one face so that neighbouring facets turn by at most `angle` (radians) and stay within
  /// `deflection` of the surface. A function of the face and the arguments alone: never of what else was
  /// triangulated before. Those that are kept are not made again for the same arguments; one triangulation is
  /// kept for each face. Throws CadError naming the face when the CAD library fails on it.
  enum class Keep : bool { no, yes };
  Facets facets(FaceId id, double deflection, double angle, Keep keep = Keep::no) const;

  struct Data;  ///< hidden from everyone but this folder
  explicit Model(std::shared_ptr<const Data> data) : _data(std::move(data)) {}
  const Data& data() const { return *_data; }

private:
  std::shared_ptr<const Data> _data;
};

}  // namespace aeroloom::cad
