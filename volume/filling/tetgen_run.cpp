#include "volume/filling/tetgen_run.hpp"

#define TETLIBRARY
#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>

#include <tetgen.h>

namespace aeroloom::volume {
namespace {

/// The input in TetGen's structures. tetgenio frees every array with delete[].
class Input {
public:
  Input(std::span<const double> coordinates, std::span<const std::array<mesh::LocalIndex, 3>> triangles) {
    _io.numberofpoints = static_cast<int>(coordinates.size() / 3);
    _io.pointlist = new REAL[coordinates.size()];
    std::copy(coordinates.begin(), coordinates.end(), _io.pointlist);
    const auto count = static_cast<int>(triangles.size());
    _io.numberoffacets = count;
    _io.facetlist = new tetgenio::facet[count];
    for (int t = 0; t < count; ++t) {
      auto& facet = _io.facetlist[t];
      tetgenio::init(&facet);
      facet.numberofpolygons = 1;
      facet.polygonlist = new tetgenio::polygon[1];
      facet.polygonlist[0].numberofvertices = 3;
      facet.polygonlist[0].vertexlist = new int[3]{triangles[t][0], triangles[t][1], triangles[t][2]};
    }
  }
  tetgenio& io() { return _io; }

private:
  tetgenio _io;
};

std::string explain(int code) {
  switch (code) {
    case 1:
      return "TetGen ran out of memory";
    case 2:
      return "TetGen met an internal error";
    case 3:
      return "TetGen found the surface to intersect itself";
    case 4:
      return "TetGen found a feature too small for it";
    case 5:
      return "TetGen found two surface triangles too close to each other";
    case 10:
      return "TetGen refused its input";
    default:
      return "TetGen stopped with code " + std::to_string(code);
  }
}

/// Numbers the points from 0 as they were given, after them what TetGen added.
std::vector<double> number_points(tetgenmesh& mesh, std::size_t given) {
  std::vector<double> added;
  int number = 0;
  mesh.points->traversalinit();
  for (auto* p = mesh.pointtraverse(); p != nullptr; p = mesh.pointtraverse(), ++number) {
    mesh.setpointmark(p, number);
    if (static_cast<std::size_t>(number) >= given) added.insert(added.end(), p, p + 3);
  }
  return added;
}

/// `requested` is empty or has all points.
void collect_cells(tetgenmesh& mesh, std::span<const std::uint8_t> requested, TetgenMesh& result) {
  const auto most = static_cast<std::size_t>(mesh.tetrahedrons->items - mesh.hullsize);
  std::vector<tetgenmesh::tetrahedron*> origin;
  origin.reserve(most);
  result.cells.reserve(most);
  mesh.tetrahedrons->traversalinit();
  for (auto* t = mesh.tetrahedrontraverse(); t != nullptr; t = mesh.tetrahedrontraverse()) {
    std::array<mesh::LocalIndex, 4> cell;
    for (int k = 0; k < 4; ++k) cell[k] = mesh.pointmark(reinterpret_cast<tetgenmesh::point>(t[4 + k]));
    if (!requested.empty() &&
        std::none_of(cell.begin(), cell.end(), [&](mesh::LocalIndex v) { return requested[v] != 0; })) {
      mesh.setelemindex(t, not_requested);
      continue;
    }
    mesh.setelemindex(t, static_cast<int>(result.cells.size()));
    result.cells.push_back(cell);
    origin.push_back(t);
  }
  result.neighbours.reserve(result.cells.size());
  for (tetgenmesh::tetrahedron* t : origin) {
    auto& across = result.neighbours.emplace_back();
    for (int face = 0; face < 4; ++face) {
      tetgenmesh::triface side, other;
      side.tet = t;
      side.ver = face;
      mesh.fsym(side, other);
      if (issubface(side)) {
        tetgenmesh::face triangle;
        mesh.tspivot(side, triangle);
        across[face] = -1 - mesh.shellmark(triangle);  // marks count from 1
      } else {
        across[face] = mesh.ishulltet(other) ? -1 : mesh.elemindex(other.tet);
      }
    }
  }
}

/// Puts all segments or triangles on the stack for recovery. The last one put there comes first.
void push_all(tetgenmesh& mesh, tetgenmesh::memorypool& all, tetgenmesh::arraypool& stack) {
  std::vector<tetgenmesh::face> items(static_cast<std::size_t>(all.items));
  all.traversalinit();
  for (tetgenmesh::face& item : items) item.sh = mesh.shellfacetraverse(&all);
  for (std::size_t i = items.size(); i-- > 0;) {
    void* place = nullptr;
    stack.newindex(&place);
    *static_cast<tetgenmesh::face*>(place) = items[i];
  }
}

/// Recovers in the order of the input what the first level of flips can recover: nearly everything. TetGen's
/// recoverboundary() goes through all of it in random order and mostly waits for memory. Later it skips what
/// is recovered, and treats the rest with more flips and points.
void recover_in_order(tetgenmesh& mesh) {
  constexpr int log_of_block = 8;  // 256 at a time, as TetGen has it for its own arrays
  tetgenmesh::arraypool missing(sizeof(tetgenmesh::face), log_of_block);
  mesh.checksubsegflag = 1;
  push_all(mesh, *mesh.subsegs, *mesh.subsegstack);
  mesh.recoversegments(&missing, 0, 0);
  if (missing.objects > 0) return;  // triangles need all of theirs
  mesh.checksubfaceflag = 1;
  push_all(mesh, *mesh.subfaces, *mesh.subfacstack);
  mesh.recoversubfaces(&missing, 0);
}

/// The order of tetrahedralize(), without two of its passes. carveholes(): the hull is kept, and
/// select_owned() finds inside and outside. recoverdelaunay(): it has hardly anything to do where all points
/// are given at once, and nearly doubles time and memory.
void run_phases(tetgenmesh& mesh) {
  clock_t unused = 0;
  mesh.initializepools();
  mesh.transfernodes();
  // Else points nearer to each other than 1e-8 of the box, which the surface has, become one.
  mesh.b->minedgelength = 0;
  exactinit(0, 0, 0, mesh.xmax - mesh.xmin, mesh.ymax - mesh.ymin, mesh.zmax - mesh.zmin);
  mesh.incrementaldelaunay(unused);
  if (mesh.in->numberoffacets == 0) return;
  mesh.meshsurface();
  recover_in_order(mesh);
  mesh.recoverboundary(unused);
  if (mesh.subvertstack->objects > 0) mesh.suppresssteinerpoints();
}

}  // namespace

TetgenMesh run_tetgen(std::span<const double> coordinates,
                      std::span<const std::array<mesh::LocalIndex, 3>> triangles,
                      std::span<const std::uint8_t> requested) {
  Input input(coordinates, triangles);
  tetgenbehavior behaviour;
  char switches[] = "pYO0Q";
  behaviour.parse_commandline(switches);
  behaviour.convex = 1;
  behaviour.regionattrib = 1;  // without it the hull is carved all the same
  auto mesh = std::make_unique<tetgenmesh>();
  mesh->b = &behaviour;
  mesh->in = &input.io();
  try {
    run_phases(*mesh);
  } catch (int code) {
    // Before it throws, TetGen frees what the destructor would free again.
    static_cast<void>(mesh.release());
    throw std::runtime_error(explain(code));
  }
  TetgenMesh result;
  result.added = number_points(*mesh, coordinates.size() / 3);
  collect_cells(*mesh, result.added.empty() ? requested : std::span<const std::uint8_t>{}, result);
  return result;
}

}  // namespace aeroloom::volume
