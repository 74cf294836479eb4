/// Boundary layers: columns of nodes on the vertices of a wall mesh, and the cap they end in.
///
/// Cells are implicit. Layer k over a wall triangle has the nodes k - 1 and k of its three columns, each
/// clipped at its own count: three live columns make a prism, two a pyramid, one a tetrahedron. A lateral
/// face depends on the columns of its edge alone, so neighbours and pieces conform for any counts.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/distributed_mesh.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <string_view>
#include <tuple>
#include <vector>

namespace aeroloom::layers {

/// The layers that a patch asks for. Heights are in the unit of the mesh.
struct WallLayers {
  double first = 0;           ///< height of the first layer; 0: no layers
  double growth = 1.2;        ///< of a layer over the one before, at least 1
  std::int32_t constant = 2;  ///< layers as high as the first, at least 1
  /// At most so many layers; 0: as many as it takes until the last is about 0.7 of the mean edge at the
  /// vertex.
  std::int32_t count = 0;
  double total = 0;  ///< height of all layers at most; 0: any
};

/// The cells of layers: prisms, with pyramids and tetrahedra where counts differ, or all of them cut into
/// tetrahedra.
enum class LayerElements : std::uint8_t { prisms, tets };

struct LayerOptions {
  std::vector<WallLayers> patches;  ///< by patch index of the mesh; those left out have no layers
  std::int32_t stairs = 3;  ///< by which the counts at the ends of an edge may differ at most, at least 1
  /// Whether layers end on planes of symmetry, slip, inlet and outlet: columns there lie in the plane, whose
  /// own triangles have to be made anew. Otherwise layers step down to zero beside them.
  bool ends_on_planes = false;
  LayerElements elements = LayerElements::prisms;  ///< that the report counts; columns are the same
};

/// The columns of a piece, by vertex. Node k of a column stands at the height of the first k layers:
/// `constant` of `first`, then each `growth` times the one before.
struct PieceColumns {
  std::vector<geometry::Vec3> directions;  ///< unit, into the fluid; zero: there is none
  std::vector<std::int32_t> counts;        ///< of layers; 0: the column is empty
  std::vector<std::int32_t> constant;
  std::vector<double> first, growth;
};

struct Columns {
  std::vector<PieceColumns> pieces;  ///< in the order of mesh.pieces
};

/// The height of node k over the wall vertex. The sum runs from the wall: what adds the heights one by one
/// has the same bits.
double height(const PieceColumns& columns, mesh::LocalIndex vertex, std::int32_t k);
/// Node k of a column, 0 <= k <= its count: 0 is the wall vertex, the last one the vertex of the cap.
geometry::Vec3 node(const mesh::Piece& wall, const PieceColumns& columns, mesh::LocalIndex vertex,
                    std::int32_t k);

/// What keeps a column from the layers asked for.
enum class LayerLimit : std::int32_t {
  none,
  no_direction,  ///< no direction sees all triangles around the vertex, or these are no plain star
  ending,        ///< layers may not end on a face beside the vertex
  gap,           ///< another part of the boundary lies opposite
  validity,      ///< cells, or triangles of the cap, would be bad
  slope,         ///< the total height differs too much from a neighbour's
  stairs,        ///< the count differs too much from a neighbour's
  crossing       ///< the cap would meet itself or the boundary
};
inline constexpr std::size_t layer_limit_count = 8;
inline constexpr std::array<LayerLimit, layer_limit_count> all_layer_limits = {
    LayerLimit::none,     LayerLimit::no_direction, LayerLimit::ending, LayerLimit::gap,
    LayerLimit::validity, LayerLimit::slope,        LayerLimit::stairs, LayerLimit::crossing};
/// As keys of reports have it.
std::string_view name_of(LayerLimit limit);

/// The layers of a patch. Each vertex counts for a third of the triangles around it. Areas are in the unit of
/// the mesh, squared.
struct PatchLayers {
  double area = 0;             ///< of triangles that ask for layers
  double full_area = 0;        ///< with as many layers as asked for
  double partial_area = 0;     ///< with fewer
  double empty_area = 0;       ///< with none
  double isotropic_area = 0;   ///< full, and the last layer at least 0.35 of the mean edge at the vertex high
  double compressed_area = 0;  ///< with layers that grow slower than asked for
  /// Of what is neither full nor unsqueezed, by what limited it last: a LayerLimit.
  std::array<double, layer_limit_count> limited_area{};
  double layers_area = 0;  ///< sum of areas times their layers: over `area`, the mean number of layers
  std::int64_t triangles = 0, prisms = 0, pyramids = 0, tetrahedra = 0;  ///< of `area`, and cells over them
  std::int64_t most_layers = 0;

  static constexpr auto fields() {
    return std::tuple(&PatchLayers::area, &PatchLayers::full_area, &PatchLayers::partial_area,
                      &PatchLayers::empty_area, &PatchLayers::isotropic_area, &PatchLayers::compressed_area,
                      &PatchLayers::limited_area, &PatchLayers::layers_area, &PatchLayers::triangles,
                      &PatchLayers::prisms, &PatchLayers::pyramids, &PatchLayers::tetrahedra,
                      &PatchLayers::most_layers);
  }
};

/// The same on every rank, and on any number of them.
struct LayerReport {
  std::vector<PatchLayers> patches;  ///< by patch index of the mesh
  int validity_rounds = 0;           ///< until all cells were good
  int crossing_rounds = 0;           ///< until the cap was free of intersections
  std::int64_t crossings = 0;        ///< pairs of triangles that met on the way
  std::int64_t enclosing = 0;        ///< triangles whose layers held another part of the boundary on the way
  std::int64_t zeroed_by_force = 0;  ///< columns emptied after the last round
};

struct Layers {
  Columns columns;
  /// The wall mesh with moved vertices: the same pieces, triangles, faces, patches, classification and
  /// shared-vertex keys; where planes were meshed again, as that has left it.
  mesh::DistributedMesh cap;
  LayerReport report;
};

/// Meshes the planes that layers end on again, in a cap whose vertices on their boundaries have moved.
/// Pieces of other faces stay, keep their order and come first. Returns the shared-vertex keys of vertices
/// that must move less, the same on every rank, and leaves the cap alone then; none: done. Collective.
using PlaneRemesher = std::function<std::vector<mesh::SharedVertexKey>(mesh::DistributedMesh& cap)>;

/// Of a piece of a wall, so that many ranks share layers evenly: pieces of surface meshing are whole faces in
/// most models. Chosen, not measured.
constexpr mesh::LocalIndex wall_piece_triangles = 1'000;

/// Columns on the walls of a surface mesh whose triangles are free of intersections, and a cap that is so
/// too; all cells between have positive volumes. A function of mesh and options alone, whatever the ranks.
/// Heights only ever shrink on the way, and at zero the cap is the wall: so there is a result for every
/// mesh. `remesh_planes` is called, maybe several times, where layers end on planes; their pieces have no
/// triangles of other faces then. Collective. Throws CollectiveError where options do not fit the mesh.
Layers build_layers(const mesh::NumberedMesh& wall, const LayerOptions& options,
                    const PlaneRemesher& remesh_planes = {});

}  // namespace aeroloom::layers
