/// What is behind a Model: shapes of the CAD library and evaluators. Seen by this folder only.
#pragma once

#include "cad/model/evaluation/surface_evaluator.hpp"
#include "cad/model/model.hpp"
#include "cad/model/named_shape.hpp"

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <Geom2dAdaptor_Curve.hxx>
#include <GeomAdaptor_Curve.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>

namespace aeroloom::cad {

/// What a face is called in the model.
struct FaceTag {
  std::string name;
  std::string patch;
  bool far_field = false;
  std::string part = {}, layer = {}, colour = {};
  std::int32_t number = -1;  ///< in the file
};

/// The solids of a shape around each of its faces, both by TopExp's order; one, or two for inner faces.
std::vector<std::vector<int>> solids_around_faces(const TopoDS_Shape& shape);

class FacetedGeometry;

/// Builds the model of a shape whose faces all belong to solids, and of facets: of one of the two, or both.
/// `tags` follow TopExp's order of faces, then that of the faces of facets. Throws CadError.
Model build_model(const NamedShape& named, const std::vector<FaceTag>& tags,
                  const FacetedGeometry* faceted = nullptr);

/// The bytes of a model with these strips closed (blunt_edges.hpp), from those of the model before.
std::vector<std::byte> with_closed_edges(std::span<const std::byte> bytes, const std::vector<FaceId>& strips);

/// The number of the patch with this name, which is appended where there is none yet.
std::int32_t patch_number(std::vector<std::string>& patches, const std::string& name);

/// The box of a shape's geometry, without the gaps that tolerances and control points would add.
Box tight_box(const TopoDS_Shape& shape);
/// The box of several shapes' geometry: faces within the box of the others' edges and faces cost next to
/// nothing.
Box tight_box(const std::vector<TopoDS_Shape>& shapes);

/// Relative error of areas in FacePlace and in the diagnosis; Model::face_area is more precise. Without one
/// the CAD library takes the most points its rules have in every span of a spline, ten times as long.
inline constexpr double area_precision = 1e-3;

/// Area and centre of a face to `area_precision`, and the box of its geometry.
FacePlace place_of(const TopoDS_Face& face);

/// The parameter curve of one coedge along an edge.
struct UseCurve {
  Coedge use;
  Geom2dAdaptor_Curve curve;
  double first = 0, last = 0;  ///< parameters of the curve at the ends of the edge's interval
};

struct EdgeEvaluator {
  TopoDS_Edge shape;        ///< oriented forward
  GeomAdaptor_Curve curve;  ///< not set on degenerate edges
};

/// One parameter direction of a surface.
struct ParameterRange {
  double low = 0,
         high = 0;      ///< natural range; of a periodic direction, one period from where the face begins
  double period = 0;    ///< 0 where it is not periodic
  bool closed = false;  ///< both ends are the same curve, without being periodic

  /// The length after which points repeat; 0 where they do not.
  double repeats_after() const { return period > 0 ? period : closed ? high - low : 0; }
  /// The parameter of the same point inside the range.
  double wrap(double parameter) const { return wrap_parameter(parameter, low, high, repeats_after()); }
};

struct FaceEvaluator {
  TopoDS_Face shape;      ///< oriented forward
  bool reversed = false;  ///< the normal out of the front region is opposite to du x dv
  bool planar = false;
  SurfaceEvaluator surface;
  ParameterRange u, v;
  Vec2 uv_low, uv_high;        ///< the box of the face's loops in parameters
  std::vector<UseCurve> uses;  ///< by (edge, use)

  const UseCurve& use(const Coedge& wanted) const;
};

/// Parameters of a point that lies on the face, from parameters near it.
Vec2 find_parameters(const FaceEvaluator& face, Vec3 point, Vec2 guess, double tolerance);

/// Coordinates that are known exactly, from axis-aligned planes (plane_snap.hpp).
struct Snap {
  std::array<bool, 3> fixed{};
  Vec3 value;

  void fix(int axis, double position) {
    if (fixed[axis]) return;
    fixed[axis] = true;
    value[axis] = position;
  }
  Vec3 operator()(Vec3 p) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (fixed[axis]) p[axis] = value[axis];
    }
    return p;
  }
};

class FaceCache;
struct ClosedEdges;
struct FaceIntegrals;
struct JoinedModel;

struct Model::Data {
  /// Over a face, seen from the middle of the model; its area is positive.
  const FaceIntegrals& integrals(FaceId id) const;
  bool is_reversed(FaceId id) const;  ///< as FaceEvaluator::reversed

  std::vector<std::byte> bytes;
  TopoDS_Shape shape;
  std::vector<Vec3> vertices;
  std::vector<Edge> edges;
  std::vector<EdgeEvaluator> edge_evaluators;
  std::vector<Face> faces;
  std::vector<FaceEvaluator> face_evaluators;
  std::vector<Snap> vertex_snaps, edge_snaps, face_snaps;
  std::vector<char> far_field;
  std::vector<std::string> region_names;
  std::vector<std::string> patches;
  Box bounds, body_bounds;
  std::string unit_name;
  double unit_in_metres = 1;
  double gap = 0;
  std::shared_ptr<FaceCache> cache;           ///< of what is computed on demand; none where faces are joined
  std::shared_ptr<const ClosedEdges> closed;  ///< where strips are closed: edges that the shape does not have
  std::shared_ptr<const JoinedModel> joined;  ///< where faces are joined: evaluators and snaps are its base's

  /// Entities of facets: numbered after those of the shape, from these numbers on. They have no evaluators.
  std::shared_ptr<const FacetedGeometry> faceted;
  VertexId first_faceted_vertex = 0;
  EdgeId first_faceted_edge = 0;
  FaceId first_faceted_face = 0;

  /// The part that the face or edge belongs to; null where it is of the shape.
  const FacetedGeometry* faceted_face(FaceId id) const {
    return faceted && id >= first_faceted_face ? faceted.get() : nullptr;
  }
  const FacetedGeometry* faceted_edge(EdgeId id) const {
    return faceted && id >= first_faceted_edge ? faceted.get() : nullptr;
  }

  /// "face 12 'wing_upper' near (x, y, z)", for messages.
  std::string describe_face(FaceId id) const;
};

}  // namespace aeroloom::cad
