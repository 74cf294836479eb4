/// Boundary layers: columns of nodes on the vertices of a wall mesh. The upper ends of the columns form the
/// layer cap, the outer surface of the layers.
///
/// Cells are not stored but follow from the columns. Layer k over a wall triangle lies between nodes k - 1
/// and k of its three columns. A column that is shorter contributes its last node. Three columns that reach
/// layer k make a prism, two a pyramid, one a tetrahedron. A lateral face depends only on the two columns of
/// its edge. So neighbouring cells and pieces conform for any counts.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/distributed_mesh.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

namespace aeroloom::layers {

class CurvedEnds;   // layers/curved_ends.hpp
struct OpenedWall;  // layers/opened_wall.hpp

/// The layers requested on a patch. Heights are in the length unit of the mesh.
struct WallLayers {
  double first = 0;           ///< height of the first layer; 0: no layers
  double growth = 1.2;        ///< ratio of a layer's height to the one below, at least 1
  std::int32_t constant = 2;  ///< number of layers as high as the first, at least 1
  /// Largest number of layers; 0: layers grow until the last is about 0.7 of the mean edge at the vertex.
  std::int32_t count = 0;
  double total = 0;  ///< largest total height; 0: no limit
};

/// The cells made from layers: prisms, with pyramids and tetrahedra where counts differ; or tetrahedra only.
enum class LayerElements : std::uint8_t { prisms, tets };
/// Which sharp edges have fans.
enum class FanPlaces : std::uint8_t { none, all };

/// How the CAD surface turns over an edge.
enum class EdgeTurn : std::uint8_t {
  unknown,  ///< a ridge where the mesh turns sharply
  smooth,   ///< no ridge, however coarse its mesh is
  upright,  ///< the same, where the wall ends on a plane
  sharp     ///< a ridge all along it, where the mesh turns at all
};
inline bool may_be_ridge(EdgeTurn turn) {
  return turn == EdgeTurn::unknown || turn == EdgeTurn::sharp;
}

/// The sides on which inner faces have layers. The front of a face between two regions lies in its front
/// region (mesh::FaceSides), that of a baffle where its normal points.
enum class InnerSides : std::uint8_t { none, front, back, both };
/// The name used in cases and reports.
std::string_view name_of(InnerSides sides);

struct LayerOptions {
  std::vector<WallLayers> patches;      ///< by patch index of the mesh; missing ones have no layers
  std::vector<InnerSides> inner_sides;  ///< by patch, of its inner faces; missing ones: none
  /// Whether layers may end on planes of symmetry, slip, inlet and outlet. Columns at their rims then lie in
  /// the plane, and the plane is meshed again. Otherwise counts fall to zero before such a plane.
  bool ends_on_planes = false;
  /// The curved faces of these types, and far fields, that layers end on as on planes where a wall meets
  /// them; nothing: on none.
  std::shared_ptr<const CurvedEnds> curved_ends;
  LayerElements elements = LayerElements::prisms;  ///< tets: vertices have one column each
  FanPlaces fans = FanPlaces::all;
  bool bends_columns = false;   ///< where the wall has rows of stretched triangles
  std::vector<EdgeTurn> edges;  ///< by CAD edge; missing ones are unknown
};

/// The sides on which inner faces of the patch have layers.
inline InnerSides inner_sides_of(const LayerOptions& options, std::size_t patch) {
  return patch < options.inner_sides.size() ? options.inner_sides[patch] : InnerSides::none;
}

/// What closes a wall mesh between the columns of one vertex: a face without area. Its corners are columns,
/// counter-clockwise seen from the fluid: two of one vertex and two of the other over an edge of a ridge (a
/// sector), or three of one vertex, -1 the last.
struct FanFace {
  std::array<std::int32_t, 4> columns;
  std::int32_t triangle;  ///< the layered triangle that it lies beside
  /// CAD face and patch of the plane that the sector ends on at the vertex of the first two columns, and at
  /// that of the others; -1: none.
  std::array<std::int32_t, 2> end_faces{-1, -1}, end_patches{-1, -1};

  bool is_sector() const { return columns[3] >= 0; }
};

/// A triangle without area that closes the mesh of a plane at the end of a fan.
struct RimTriangle {
  std::array<std::int32_t, 3> columns;
  std::int32_t triangle;  ///< of the plane, that it lies beside
};

/// The columns of a piece. Most vertices have one, those of sharp edges several, all of the same heights.
/// Node k stands at the height of the first k layers (Heights); node 0 is the vertex.
struct PieceColumns {
  std::vector<geometry::Vec3> directions;       ///< by column: unit, into the fluid; zero: no column
  std::vector<std::int32_t> counts;             ///< by vertex: numbers of layers; 0: empty columns
  std::vector<std::int32_t> constant, regular;  ///< by vertex, as Heights has them
  std::vector<double> first, growth, stretch;   ///< by vertex
  std::vector<std::int32_t> first_column;       ///< (vertices + 1)
  std::vector<mesh::LocalIndex> vertices;       ///< by column; none: each vertex has one
  std::vector<std::array<std::int32_t, 3>>
      corner_columns;              ///< by triangle, of its corners as the piece has them
  std::vector<FanFace> fan_faces;  ///< by triangle
  std::vector<RimTriangle> rims;   ///< by triangle
  /// The columns on curved faces and those that bend, ascending, and the first of their nodes 1 to count.
  std::vector<std::array<std::int32_t, 2>> curved;
  std::vector<geometry::Vec3> curved_nodes;

  std::int32_t column_count() const { return first_column.back(); }
  std::int32_t columns_at(mesh::LocalIndex vertex) const {
    return first_column[vertex + 1] - first_column[vertex];
  }
  mesh::LocalIndex vertex_of(std::int32_t column) const {
    return vertices.empty() ? column : vertices[column];
  }
  /// Nodes 1 to count of a column on curved faces, or one that bends; nullptr of others.
  const geometry::Vec3* curved_nodes_of(std::int32_t column) const;
};

struct Columns {
  std::vector<PieceColumns> pieces;  ///< in the order of mesh.pieces
};

/// Height of node k over the wall vertex. Heights are summed from the wall, so sums built layer by layer have
/// the same bits.
double height(const PieceColumns& columns, mesh::LocalIndex vertex, std::int32_t k);
/// Position of node k of a column, 0 <= k <= count: 0 is the wall vertex, the last one is the vertex of the
/// cap.
geometry::Vec3 node(const mesh::Piece& wall, const PieceColumns& columns, std::int32_t column,
                    std::int32_t k);

/// Why a column has fewer or lower layers than requested.
enum class LayerLimit : std::int32_t {
  none,
  no_direction,  ///< no direction sees all triangles of the star, that is not closed, or a fan ends there
  ending,        ///< a face beside the vertex does not let layers end on it
  gap,           ///< another part of the boundary is too near
  validity,      ///< cells or cap triangles would be bad
  slope,         ///< the total height differs too much from a neighbour's
  crossing       ///< the cap would intersect itself or the boundary
};
inline constexpr std::size_t layer_limit_count = 7;
inline constexpr std::array<LayerLimit, layer_limit_count> all_layer_limits = {
    LayerLimit::none,     LayerLimit::no_direction, LayerLimit::ending,  LayerLimit::gap,
    LayerLimit::validity, LayerLimit::slope,        LayerLimit::crossing};
/// The name used in reports.
std::string_view name_of(LayerLimit limit);

/// Statistics of the layers on a patch. Each vertex counts a third of the triangles around it. Areas are in
/// squared length units of the mesh.
struct PatchLayers {
  double area = 0;  ///< of triangles with requested layers
  /// With all requested layers, or with fewer of which the last is at least 0.35 of the mean edge high: the
  /// step to the tetrahedra is as smooth.
  double full_area = 0;
  double partial_area = 0;    ///< with fewer layers
  double empty_area = 0;      ///< without layers
  double isotropic_area = 0;  ///< the last layer is at least 0.35 of the mean edge high
  static constexpr double low = 0.8;
  double low_first_area = 0;  ///< with a first layer, along the wall's normal, below `low` of the requested
  /// Area that is not full, by the limit that acted last (a LayerLimit).
  std::array<double, layer_limit_count> limited_area{};
  /// Of areas times: number of layers, number wanted, their height together, length of edges at the column,
  /// last layer over that. Over `area` they are means.
  struct Sums {
    double layers = 0, wanted = 0, heights = 0, edges = 0, last = 0;
  } sums;
  std::int64_t triangles = 0;                                            ///< of the wall
  std::int64_t prisms = 0, pyramids = 0, tetrahedra = 0, hexahedra = 0;  ///< cells
  std::int64_t most_layers = 0;
};

/// Statistics of a whole mesh; equal on all ranks and for any number of ranks.
struct LayerReport {
  std::vector<PatchLayers> patches;  ///< by patch index of the mesh
  int validity_rounds = 0;           ///< rounds until all cells were good
  int crossing_rounds = 0;           ///< rounds until the cap had no intersections
  std::int64_t crossings = 0;        ///< pairs of intersecting triangles found on the way
  std::int64_t enclosing = 0;  ///< triangles whose layers enclosed another part of the boundary on the way
  std::int64_t zeroed_by_force = 0;  ///< columns emptied in the last rounds
};

struct Layers {
  Columns columns;
  /// The wall mesh with its vertices moved to the ends of their columns. Pieces, triangles, faces, patches,
  /// classification and shared-vertex keys are those of the wall. Planes that were meshed again are as the
  /// remesher left them.
  mesh::DistributedMesh cap;
  LayerReport report;
  /// Where inner faces have layers: the wall that `columns` stand on. The cap is then closed again where it
  /// has no layers on either side (glued_cap.hpp).
  std::shared_ptr<const OpenedWall> opened;  // opened_wall.hpp
};

/// Meshes again the planes and curved faces that layers end on. Their rims have moved in `cap`; `wall` has
/// the same pieces before, in the same order. Other pieces stay, keep their order and come first. Returns
/// nothing on success. Else the cap is of no use, and it returns the shared-vertex keys of the vertices that
/// must move less, equal on all ranks. Collective.
using PlaneRemesher = std::function<std::vector<mesh::SharedVertexKey>(const mesh::DistributedMesh& wall,
                                                                       mesh::DistributedMesh& cap)>;

/// Triangles per wall piece. Pieces of surface meshing are often whole CAD faces, too large to balance layers
/// over ranks. Chosen, not measured.
constexpr mesh::LocalIndex wall_piece_triangles = 1'000;
/// About what a wall piece costs the stage, in triangles with layers: ranks get pieces by it.
double predict_wall_load(const mesh::Piece& piece, const LayerOptions& options);

/// Builds columns on the walls of a surface mesh without self-intersections. The resulting cap has no
/// intersections either, and all cells between have positive volume. The result depends only on mesh and
/// options, not on ranks. Heights only shrink, and a cap of height zero is the wall, so a result exists for
/// every mesh. `remesh_planes` is needed where layers end on planes, and may be called several times; pieces
/// of these planes must have no triangles of other faces. Collective. Throws CollectiveError if the options
/// do not fit the mesh.
Layers build_layers(const mesh::NumberedMesh& wall, const LayerOptions& options,
                    const PlaneRemesher& remesh_planes = {});

}  // namespace aeroloom::layers
