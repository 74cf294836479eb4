/// Implementation of Model: CAD shapes and evaluators. Internal to cad/.
#pragma once

#include "cad/model/evaluation/surface_evaluator.hpp"
#include "cad/model/model.hpp"
#include "cad/model/named_shape.hpp"
#include "cad/model/patch_origin.hpp"

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

/// Names of a face in the model.
struct FaceTag {
  std::string name;
  std::string patch;
  bool far_field = false;
  std::string part = {}, layer = {}, colour = {};
  std::int32_t number = -1;  ///< in the file
  PatchOrigin origin = PatchOrigin::file;
};

/// Names of the solids, in order: those of their faces, or "region_<number>".
std::vector<std::string> region_names(const NamedShape& named);

/// The solids on the sides of each face, one or two, in the order of TopExp.
std::vector<std::vector<int>> solids_around_faces(const TopoDS_Shape& shape);

class FacetedGeometry;

/// Builds a model from a shape whose faces all belong to solids, from faceted geometry, or from both. `tags`
/// follow the faces of the shape in the order of TopExp, then the faceted ones. Throws CadError.
Model build_model(const NamedShape& named, const std::vector<FaceTag>& tags,
                  const FacetedGeometry* faceted = nullptr);

/// The bytes of a model with these strips closed (blunt_edges.hpp), from the bytes of the model before.
std::vector<std::byte> with_closed_edges(std::span<const std::byte> bytes, const std::vector<FaceId>& strips);

/// The number of a patch. Its name is appended if it is new.
std::int32_t patch_number(std::vector<std::string>& patches, const std::string& name);

/// The tight box of a shape, without tolerances and control points.
Box tight_box(const TopoDS_Shape& shape);
/// The tight box of several shapes. Faces inside the box of the other faces and edges cost almost nothing.
Box tight_box(const std::vector<TopoDS_Shape>& shapes);

/// Relative error of areas in FacePlace and in the diagnosis; Model::face_area is more accurate. Without a
/// given error the CAD library uses its largest rules on every span, ten times as slow.
inline constexpr double area_precision = 1e-3;

/// Area and centre of a face, to `area_precision`, and its tight box.
FacePlace place_of(const TopoDS_Face& face);

/// The curve of one coedge in the parameter plane of its face.
struct UseCurve {
  Coedge use;
  Geom2dAdaptor_Curve curve;
  double first = 0, last = 0;  ///< parameters of the curve at the ends of the edge
};

struct EdgeEvaluator {
  TopoDS_Edge shape;        ///< oriented forward
  GeomAdaptor_Curve curve;  ///< not set on degenerate edges
};

/// The range of one parameter of a surface.
struct ParameterRange {
  double low = 0,
         high = 0;      ///< range of the surface; if periodic, one period from the lower end of the face
  double period = 0;    ///< 0 if not periodic
  bool closed = false;  ///< both ends are the same curve, but the surface is not periodic

  /// The period, also of closed surfaces; 0 if there is none.
  double repeats_after() const { return period > 0 ? period : closed ? high - low : 0; }
  /// The parameter of the same point inside the range.
  double wrap(double parameter) const { return wrap_parameter(parameter, low, high, repeats_after()); }
};

struct FaceEvaluator {
  TopoDS_Face shape;      ///< oriented forward
  bool reversed = false;  ///< the normal out of `front` is opposite to du x dv
  bool planar = false;
  SurfaceEvaluator surface;
  ParameterRange u, v;
  Vec2 uv_low, uv_high;        ///< box of the loops in parameters
  std::vector<UseCurve> uses;  ///< sorted by (edge, use)

  const UseCurve& use(const Coedge& wanted) const;
};

/// Parameters of a point that lies on the face near `guess`.
Vec2 find_parameters(const FaceEvaluator& face, Vec3 point, Vec2 guess, double tolerance);

/// Coordinates that are known exactly from axis-aligned planes (plane_snap.hpp).
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
struct ScaledModel;

struct Model::Data {
  /// Integrals over a face, relative to the middle of the model. The area is positive.
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
  std::shared_ptr<FaceCache> cache;  ///< null if faces are joined
  std::shared_ptr<const ClosedEdges>
      closed;  ///< for models with closed strips; their edges are not in the shape
  std::shared_ptr<const JoinedModel>
      joined;  ///< for models with joined faces; evaluators and snaps are in the base model
  std::shared_ptr<const ScaledModel>
      scaled;  ///< for models in a unit that is not that of shapes; all but topology is in it

  /// Faceted entities are numbered after those of the shape, beginning here. They have no evaluators.
  std::shared_ptr<const FacetedGeometry> faceted;
  VertexId first_faceted_vertex = 0;
  EdgeId first_faceted_edge = 0;
  FaceId first_faceted_face = 0;

  /// The faceted geometry of a face or edge; null if it belongs to the shape.
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
