#include "volume/tetgen_run.hpp"

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
    set_points(_io, coordinates);
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

  static void set_points(tetgenio& io, std::span<const double> coordinates) {
    io.numberofpoints = static_cast<int>(coordinates.size() / 3);
    io.pointlist = new REAL[coordinates.size()];
    std::copy(coordinates.begin(), coordinates.end(), io.pointlist);
  }

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

/// Numbers the points from 0: the given surface points, `inserted` ones by their place there, and what TetGen
/// added. Pool slots of removed points are reused, so inserted points are told by their coordinates.
std::vector<double> number_points(tetgenmesh& mesh, std::size_t first_given,
                                  std::span<const double> inserted) {
  const auto point_less = [](const double* a, const double* b) {
    return std::lexicographical_compare(a, a + 3, b, b + 3);
  };
  std::vector<const double*> known(inserted.size() / 3);
  for (std::size_t i = 0; i < known.size(); ++i) known[i] = inserted.data() + 3 * i;
  std::sort(known.begin(), known.end(), point_less);
  const std::size_t first_added = first_given + known.size();
  std::vector<double> added;
  std::size_t seen = 0;
  mesh.points->traversalinit();
  for (auto* p = mesh.pointtraverse(); p != nullptr; p = mesh.pointtraverse(), ++seen) {
    if (seen < first_given) {
      mesh.setpointmark(p, static_cast<int>(seen));
      continue;
    }
    const auto place = std::lower_bound(known.begin(), known.end(), p, point_less);
    if (place != known.end() && std::equal(p, p + 3, *place)) {
      mesh.setpointmark(p, static_cast<int>(first_given + (*place - inserted.data()) / 3));
    } else {
      mesh.setpointmark(p, static_cast<int>(first_added + added.size() / 3));
      added.insert(added.end(), p, p + 3);
    }
  }
  return added;
}

void collect_cells(tetgenmesh& mesh, TetgenMesh& result) {
  const auto count = static_cast<std::size_t>(mesh.tetrahedrons->items - mesh.hullsize);
  result.cells.reserve(count);
  result.neighbours.reserve(count);
  mesh.tetrahedrons->traversalinit();
  for (auto* t = mesh.tetrahedrontraverse(); t != nullptr; t = mesh.tetrahedrontraverse()) {
    mesh.setelemindex(t, static_cast<int>(result.cells.size()));
    auto& cell = result.cells.emplace_back();
    for (int k = 0; k < 4; ++k) cell[k] = mesh.pointmark(reinterpret_cast<tetgenmesh::point>(t[4 + k]));
  }
  mesh.tetrahedrons->traversalinit();
  for (auto* t = mesh.tetrahedrontraverse(); t != nullptr; t = mesh.tetrahedrontraverse()) {
    auto& across = result.neighbours.emplace_back();
    for (int face = 0; face < 4; ++face) {
      tetgenmesh::triface side, other;
      side.tet = t;
      side.ver = face;
      mesh.fsym(side, other);
      const bool open = issubface(side) || mesh.ishulltet(other);
      across[face] = open ? -1 : mesh.elemindex(other.tet);
    }
  }
}

/// The order of tetrahedralize(), without its pass recoverdelaunay() where all points were given at once:
/// hardly anything is left to do for it then, and it nearly doubles time and memory.
void run_phases(tetgenmesh& mesh, std::span<const double> later) {
  clock_t unused = 0;
  mesh.initializepools();
  mesh.transfernodes();
  exactinit(0, 0, 0, mesh.xmax - mesh.xmin, mesh.ymax - mesh.ymin, mesh.zmax - mesh.zmin);
  mesh.incrementaldelaunay(unused);
  mesh.meshsurface();
  mesh.recoverboundary(unused);
  mesh.carveholes();
  if (mesh.subvertstack->objects > 0) mesh.suppresssteinerpoints();
  if (later.empty()) return;
  tetgenio extra;
  Input::set_points(extra, later);
  mesh.recoverdelaunay();
  mesh.insertconstrainedpoints(&extra);
}

}  // namespace

TetgenMesh run_tetgen(std::span<const double> coordinates, std::size_t surface_points,
                      std::span<const std::array<mesh::LocalIndex, 3>> triangles, InteriorPoints interior) {
  const auto split = interior == InteriorPoints::at_once ? coordinates.size() : 3 * surface_points;
  const auto later = coordinates.subspan(split);
  Input input(coordinates.first(split), triangles);
  tetgenbehavior behaviour;
  char switches[] = "pYO0Q";
  behaviour.parse_commandline(switches);
  auto mesh = std::make_unique<tetgenmesh>();
  mesh->b = &behaviour;
  mesh->in = &input.io();
  try {
    run_phases(*mesh, later);
  } catch (int code) {
    // Before it throws, TetGen frees what the destructor would free again.
    static_cast<void>(mesh.release());
    throw std::runtime_error(explain(code));
  }
  TetgenMesh result;
  result.added = number_points(*mesh, split / 3, later);
  collect_cells(*mesh, result);
  return result;
}

}  // namespace aeroloom::volume
