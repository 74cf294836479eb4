#include "cad/faceted/shape_facets.hpp"

#include "cad/domain/domain_kind.hpp"
#include "cad/faceted/close_facets.hpp"
#include "cad/faceted/facet_contacts.hpp"
#include "cad/faceted/facet_sides.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/model/model_data.hpp"
#include "cad/model/shape_map.hpp"
#include "cad/model/step_trace.hpp"
#include "cad/model/to_vec.hpp"
#include "cad/tolerances.hpp"
#include "geometry/disjoint_sets.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <BRepAdaptor_Surface.hxx>
#include <BRepBuilderAPI_Copy.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <IMeshTools_Parameters.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <Precision.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>
#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// Nodes of a face in the soup, before those of neighbours become one.
struct FaceNodes {
  TopoDS_Face face;  ///< oriented forward
  Handle(Poly_Triangulation) triangulation;
  TopLoc_Location location;
  std::int32_t first = 0;
};

class ShapeTriangles {
public:
  /// `copy` is triangulated already.
  explicit ShapeTriangles(const TopoDS_Shape& copy) {
    const TopTools_IndexedMapOfShape faces = map_of(copy, TopAbs_FACE);
    for (int i = 1; i <= faces.Extent(); ++i) add_face(TopoDS::Face(faces(i)), i - 1);
  }

  /// False where a face has no triangles, or neighbours have different points on an edge.
  bool close() {
    geometry::DisjointSets<std::int32_t> same(_facets.soup.points.size());
    TopTools_IndexedMapOfShape edges, vertices;
    for (const FaceNodes& nodes : _faces) {
      if (nodes.triangulation.IsNull()) return false;
      for (TopExp_Explorer each(nodes.face, TopAbs_EDGE); each.More(); each.Next()) {
        const TopoDS_Edge edge = TopoDS::Edge(each.Current());
        const std::vector<std::int32_t> line = line_of(edge, nodes);
        if (line.size() < 2) return false;
        const auto index = static_cast<std::size_t>(edges.Add(edge)) - 1;
        if (index == _lines.size()) _lines.push_back(line);
        const std::vector<std::int32_t>& first = _lines[index];
        const bool degenerate = BRep_Tool::Degenerated(edge);
        if (!degenerate && first.size() != line.size()) return false;
        for (std::size_t k = 0; k < line.size(); ++k) same.unite(line[k], degenerate ? line[0] : first[k]);
        unite_ends(TopoDS::Edge(edge.Oriented(TopAbs_FORWARD)), line, vertices, same);
      }
    }
    std::vector<std::int32_t> representative(same.size());
    for (std::size_t p = 0; p < same.size(); ++p) representative[p] = same.root(static_cast<std::int32_t>(p));
    replace_points(_facets.soup, representative);
    weld_equal_points(_facets.soup);
    Changes dropped;
    drop_void_triangles(_facets.soup, dropped);
    return open_sides(_facets.soup.triangles).empty();
  }

  ShapeFacets take() { return std::move(_facets); }

private:
  void add_face(const TopoDS_Face& face, int group) {
    FaceNodes nodes{TopoDS::Face(face.Oriented(TopAbs_FORWARD)), {}, {}, 0};
    nodes.triangulation = BRep_Tool::Triangulation(face, nodes.location);
    nodes.first = static_cast<std::int32_t>(_facets.soup.points.size());
    _faces.push_back(nodes);
    if (nodes.triangulation.IsNull()) return;
    const Poly_Triangulation& mesh = *nodes.triangulation;
    for (int i = 1; i <= mesh.NbNodes(); ++i)
      _facets.soup.points.push_back(to_vec(mesh.Node(i).Transformed(nodes.location.Transformation())));
    const BRepAdaptor_Surface surface(face, false);
    for (int i = 1; i <= mesh.NbTriangles(); ++i) {
      int corners[3];
      mesh.Triangle(i).Get(corners[0], corners[1], corners[2]);
      if (mesh.HasUVNodes()) measure(mesh, corners, surface, nodes.first);
      for (int& corner : corners) corner += nodes.first - 1;
      if (face.Orientation() == TopAbs_REVERSED) std::swap(corners[1], corners[2]);
      _facets.soup.triangles.push_back({corners[0], corners[1], corners[2]});
      _facets.soup.group_of.push_back(group);
    }
  }

  void measure(const Poly_Triangulation& mesh, const int (&corners)[3], const BRepAdaptor_Surface& surface,
               std::int32_t first) {
    gp_XY uv;
    Vec3 middle;
    for (const int corner : corners) {
      uv += mesh.UVNode(corner).XY();
      middle += _facets.soup.points[first + corner - 1];
    }
    gp_Pnt point;
    gp_Vec du, dv;
    surface.D1(uv.X() / 3, uv.Y() / 3, point, du, dv);
    const Vec3 off = middle / 3.0 - to_vec(point), normal = to_vec(du.Crossed(dv));
    // Along the normal: parameters of the middle are not those of the nearest point.
    const bool singular =
        norm(normal) <= tolerances::rounding * (du.SquareMagnitude() + dv.SquareMagnitude());
    _facets.deviation =
        std::max(_facets.deviation, singular ? norm(off) : std::abs(dot(off, normalized(normal))));
  }

  /// The nodes along an edge of a face, in the direction of the edge's parameter.
  static std::vector<std::int32_t> line_of(const TopoDS_Edge& edge, const FaceNodes& nodes) {
    const Handle(Poly_PolygonOnTriangulation) polygon =
        BRep_Tool::PolygonOnTriangulation(edge, nodes.triangulation, nodes.location);
    std::vector<std::int32_t> line;
    if (polygon.IsNull()) return line;
    for (int i = 1; i <= polygon->NbNodes(); ++i) line.push_back(nodes.first + polygon->Node(i) - 1);
    const bool against =
        polygon->HasParameters() && polygon->Parameter(1) > polygon->Parameter(polygon->NbNodes());
    if (against) std::reverse(line.begin(), line.end());
    return line;
  }

  void unite_ends(const TopoDS_Edge& edge, const std::vector<std::int32_t>& line,
                  TopTools_IndexedMapOfShape& vertices, geometry::DisjointSets<std::int32_t>& same) {
    TopoDS_Vertex ends[2];
    TopExp::Vertices(edge, ends[0], ends[1]);
    for (int i = 0; i < 2; ++i) {
      const std::int32_t node = i == 0 ? line.front() : line.back();
      const auto index = static_cast<std::size_t>(vertices.Add(ends[i])) - 1;
      if (index == _at_vertex.size()) _at_vertex.push_back(node);
      same.unite(_at_vertex[index], node);
    }
  }

  ShapeFacets _facets;
  std::vector<FaceNodes> _faces;
  std::vector<std::vector<std::int32_t>> _lines;  // of each edge, as the first face has it
  std::vector<std::int32_t> _at_vertex;
};

void name_groups(const TopoDS_Solid& solid, const FaceLabels& labels, FacetSoup& soup) {
  NamedShape named;
  named.shape = solid, named.labels = labels;
  const std::vector<FaceTag> tags = tag_faces(named, DomainKind::body, nullptr);
  const TopTools_IndexedMapOfShape faces = map_of(solid, TopAbs_FACE);
  for (std::size_t i = 0; i < tags.size(); ++i) {
    const FaceTag& tag = tags[i];
    soup.groups.push_back({tag.name.empty() ? fmt::format("face_{}", i) : tag.name, tag.part, tag.patch,
                           tag.layer, tag.colour, tag.number});
    soup.groups.back().origin = tag.origin;
    const FaceLabel* label = labels.Seek(faces(static_cast<int>(i) + 1));
    soup.groups.back().cap = label != nullptr && label->cap;
  }
}

}  // namespace

ShapeFacets facets_of(const TopoDS_Solid& solid, const FaceLabels& labels, const FacetLimits& limits) {
  report_step("triangulating a body");
  for (const double fraction : {1.0, 0.25, 0.06, 0.015}) {
    BRepBuilderAPI_Copy copy(solid, false, false);
    IMeshTools_Parameters parameters;
    parameters.Deflection = std::max(fraction * limits.deflection, 2 * Precision::Confusion());
    parameters.Angle = limits.angle;
    parameters.AngleInterior = limits.angle;
    parameters.InParallel = false;
    BRepMesh_IncrementalMesh mesher(copy.Shape(), parameters);
    ShapeTriangles triangles(copy.Shape());
    if (!triangles.close()) continue;
    ShapeFacets facets = triangles.take();
    if (!list_facet_contacts(facets.soup).empty()) continue;
    name_groups(solid, labels, facets.soup);
    return facets;
  }
  throw CadError(
      fmt::format("the body around {} cannot be cut into triangles that close without crossing each other. "
                  "Remedy: repair the body in the CAD program",
                  place_in_file(tight_box(solid).center())));
}

}  // namespace aeroloom::cad
