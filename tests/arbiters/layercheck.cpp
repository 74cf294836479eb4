/// Judges a mesh with boundary layers by its files alone. The last line is `VALID yes` or `VALID NO`; the
/// exit code is 0, 1, or 2 where the command line is wrong.
///
/// layercheck MESH(.vtu|.pvtu) [--surface FILE(.vtp|.pvtp)] [--inner FILE] [--walls FILE] [--regions N]
///   [--sphere PATCH x y z radius] [--cylinder PATCH x y z ax ay az radius] [--plane PATCH x y z nx ny nz]
///
/// - Cells are tetrahedra, prisms, pyramids and hexahedra. Their volumes are positive, and so are those of
///   the tetrahedra at their corners, of prisms all twelve into which they can be cut.
/// - A face belongs to two cells, which see it from opposite sides, or to one and to the boundary. The
///   boundary is closed. No quadrilateral of it lies in front of two of its triangles. No point is unused.
/// - The cells' volumes, by integrals of shape functions, sum up to what the boundary encloses, by the
///   divergence theorem.
/// - --surface: its polygons are the boundary's faces, each once, and enclose as much. Together with the
///   above this leaves no voids and overlaps where the surface does not meet itself.
/// - --inner: its polygons, faces between regions or baffles, are faces with a cell on either side. Cells
///   of different regions meet nowhere else.
/// - Quadrilaterals of the boundary are planar. But patches of which --sphere, --cylinder or --plane tell
///   their CAD surfaces (as often as there are such) have all corners on these instead. This needs
///   --surface, where patches have names.
/// - --walls: the surface of the same case without layers encloses as much. Where layers end on curved
///   faces it does not.
/// - --regions: as many parts (1) are connected over faces that are not inner ones.
///
/// For information: number of layers over the area of walls and inner faces, first heights, growth, shapes.
#include "boundary.hpp"
#include "cells.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <optional>

namespace layercheck {
namespace {

struct Options {
  std::string mesh, surface, inner, walls;
  long regions = 1;
  std::vector<CadSurface> surfaces;
};

std::optional<Options> parse(const std::vector<std::string>& words) {
  if (words.empty() || words[0].starts_with("--")) return std::nullopt;
  Options options{words[0], {}, {}, {}, 1, {}};
  std::size_t at = 1;
  while (at < words.size()) {
    const std::string& name = words[at++];
    const auto numbers =
        static_cast<std::size_t>(numbers_of(name.substr(std::min<std::size_t>(2, name.size()))));
    if (at + 1 + numbers > words.size()) return std::nullopt;
    const std::string& value = words[at++];
    if (numbers > 0) {
      CadSurface surface{name.substr(2), value, {}};
      while (surface.numbers.size() < numbers) surface.numbers.push_back(std::atof(words[at++].c_str()));
      options.surfaces.push_back(surface);
    } else if (name == "--regions") {
      options.regions = std::atol(value.c_str());
    } else if (name == "--surface" || name == "--inner" || name == "--walls") {
      (name == "--surface" ? options.surface : name == "--inner" ? options.inner : options.walls) = value;
    } else {
      return std::nullopt;
    }
  }
  if (!options.surfaces.empty() && options.surface.empty()) return std::nullopt;
  return options;
}

void print_quantiles(const char* name, std::vector<double> values) {
  if (values.empty()) return;
  std::sort(values.begin(), values.end());
  std::printf("%s:", name);
  for (const double part : {0.0, 0.01, 0.05, 0.5, 0.95, 0.99, 1.0})
    std::printf("  %g %% %.4g", 100 * part, values[static_cast<std::size_t>(part * (values.size() - 1))]);
  std::printf("  (%zu)\n", values.size());
}

/// What lies behind the two triangles of each prism: another cell, or nothing where columns begin.
struct Columns {
  std::vector<std::array<Index, 2>> across;  ///< -1: none
  std::vector<std::array<char, 2>> begins;
};

struct Faces {
  std::vector<CellFace> boundary, inside;
  std::vector<FaceKey> inner;  ///< of the polygons of --inner
  long crowded = 0;            ///< in more than two cells
  long same_side = 0;          ///< seen from one side by both cells
  long unmarked = 0;           ///< between regions and not of --inner
  long one_sided = 0;          ///< of --inner without a cell on either side
  long parts = 0;
  Columns columns;
};

/// Marks what is behind a face whose cells are given: two, or the same one twice on the boundary.
void note_columns(const Mesh& mesh, const CellFace& face, Index behind, Columns& columns) {
  if (mesh.cells[face.cell].type != prism || face.side > 1) return;
  columns.across[face.cell][face.side] = behind;
  columns.begins[face.cell][face.side] = behind < 0;
}

class Parts {
public:
  explicit Parts(std::size_t cells) : _parent(cells) { std::iota(_parent.begin(), _parent.end(), 0); }
  void join(Index a, Index b) { _parent[root(a)] = root(b); }
  long count() {
    long roots = 0;
    for (std::size_t c = 0; c < _parent.size(); ++c) roots += _parent[c] == static_cast<Index>(c);
    return roots;
  }

private:
  Index root(Index cell) {
    while (_parent[cell] != cell) cell = _parent[cell] = _parent[_parent[cell]];
    return cell;
  }
  std::vector<Index> _parent;
};

Faces match_faces(const Mesh& mesh, const std::vector<Polygon>& inner) {
  const std::vector<CellFace> faces = all_faces(mesh);
  Faces found;
  found.inner = keys_of(mesh, inner);
  found.columns.across.assign(mesh.cells.size(), {-1, -1});
  found.columns.begins.assign(mesh.cells.size(), {0, 0});
  Parts parts(mesh.cells.size());
  std::vector<FaceKey> two_sided;
  for (std::size_t i = 0, j = 0; i < faces.size(); i = j) {
    while (j < faces.size() && faces[j].key == faces[i].key) ++j;
    const CellFace &front = faces[i], &back = faces[j - 1];
    if (j - i > 2) ++found.crowded;
    if (j - i == 1) {
      found.boundary.push_back(front);
      note_columns(mesh, front, -1, found.columns);
    }
    if (j - i != 2) continue;
    const bool good = opposite(front, back);
    const bool marked = std::binary_search(found.inner.begin(), found.inner.end(), front.key);
    found.same_side += !good;
    found.unmarked += !marked && mesh.cells[front.cell].region != mesh.cells[back.cell].region;
    if (good && marked) two_sided.push_back(front.key);
    if (!marked) parts.join(front.cell, back.cell);
    note_columns(mesh, front, marked ? -1 : back.cell, found.columns);
    note_columns(mesh, back, marked ? -1 : front.cell, found.columns);
  }
  found.parts = parts.count();
  // Each polygon stands for a face of its own.
  found.one_sided = static_cast<long>(found.inner.size()) - static_cast<long>(two_sided.size());
  return found;
}

/// The heights of the layers over a triangle of a prism, and of the first one at each corner.
struct Column {
  double area;
  std::vector<double> heights, first;
};

Column trace_column(const Mesh& mesh, const Columns& columns, Index cell, int side) {
  Column column{};
  while (true) {
    const auto& n = mesh.cells[cell].node;
    const int near = side == 0 ? 0 : 3, far = 3 - near;
    const auto p = [&](int k) { return mesh.points[n[k]]; };
    const Point normal = cross(p(near + 1) - p(near), p(near + 2) - p(near));
    std::vector<double> heights;
    for (int k = 0; k < 3; ++k)
      heights.push_back(std::fabs(dot(p(far + k) - p(near + k), normal)) / length(normal));
    if (column.heights.empty()) {
      column.area = 0.5 * length(normal);
      column.first = heights;
    }
    column.heights.push_back((heights[0] + heights[1] + heights[2]) / 3);
    const Index next = columns.across[cell][1 - side];
    if (next < 0 || mesh.cells[next].type != prism || column.heights.size() > mesh.cells.size())
      return column;
    side = columns.across[next][0] == cell ? 0 : 1;
    cell = next;
  }
}

void print_columns(const Mesh& mesh, const Columns& columns) {
  std::map<std::size_t, double> area_by_layers;
  std::vector<double> first, growth;
  double area = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    for (int side = 0; side < 2; ++side) {
      if (!columns.begins[c][side]) continue;
      const Column column = trace_column(mesh, columns, static_cast<Index>(c), side);
      area += column.area;
      area_by_layers[column.heights.size()] += column.area;
      first.insert(first.end(), column.first.begin(), column.first.end());
      for (std::size_t k = 1; k < column.heights.size(); ++k)
        growth.push_back(column.heights[k] / column.heights[k - 1]);
    }
  }
  std::printf("area under prisms %.8g; its share in %% by number of layers:", area);
  for (const auto& [count, share] : area_by_layers) std::printf(" %zu:%.2f", count, 100 * share / area);
  std::puts("");
  print_quantiles("first height", first);
  print_quantiles("growth", growth);
}

bool cells_are_good(const Mesh& mesh) {
  std::map<int, long> kinds;
  std::vector<double> jacobians;
  long inverted = 0;
  double smallest = std::numeric_limits<double>::max();
  for (const Cell& cell : mesh.cells) {
    ++kinds[cell.type];
    const double corner = smallest_tetrahedron(mesh, cell);
    inverted += !(corner > 0) || !(volume_of(mesh, cell) > 0);
    smallest = std::min(smallest, corner);
    if (cell.type == prism) jacobians.push_back(scaled_jacobian(mesh, cell));
  }
  std::printf("points %zu (stored %zu, orphans %ld)\n", mesh.points.size(), mesh.points_stored, mesh.orphans);
  std::printf("tetrahedra %ld  prisms %ld  pyramids %ld  hexahedra %ld", kinds[tetrahedron], kinds[prism],
              kinds[pyramid], kinds[hexahedron]);
  for (const auto& [type, count] : mesh.other_types) std::printf("  type %d: %ld", type, count);
  std::printf("\ninverted cells %ld  smallest tetrahedron %.3g\n", inverted, smallest);
  print_quantiles("scaled Jacobian of prisms", jacobians);
  return inverted == 0 && mesh.orphans == 0 && mesh.other_types.empty();
}

long open_edges(const std::vector<CellFace>& boundary) {
  std::map<std::array<Index, 2>, int> edges;
  for (const CellFace& face : boundary) {
    for (int k = 0; k < face.corners; ++k) {
      const Index a = face.loop[k], b = face.loop[(k + 1) % face.corners];
      edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  return std::count_if(edges.begin(), edges.end(), [](const auto& edge) { return edge.second != 0; });
}

bool faces_are_good(const Faces& faces, long regions) {
  const long quadrilaterals = std::count_if(faces.boundary.begin(), faces.boundary.end(),
                                            [](const CellFace& f) { return f.corners == 4; });
  const long open = open_edges(faces.boundary), covered = covered_by_triangles(faces.boundary);
  std::printf(
      "boundary triangles %ld  quadrilaterals %ld  in front of two boundary triangles %ld  open edges %ld\n",
      static_cast<long>(faces.boundary.size()) - quadrilaterals, quadrilaterals, covered, open);
  std::printf("faces in more than two cells %ld  seen from one side twice %ld\n", faces.crowded,
              faces.same_side);
  std::printf(
      "inner polygons %zu  without a cell on either side %ld  faces between regions and not inner %ld\n",
      faces.inner.size(), faces.one_sided, faces.unmarked);
  std::printf("parts connected over other faces %ld of %ld\n", faces.parts, regions);
  return open == 0 && covered == 0 && faces.crowded == 0 && faces.same_side == 0 && faces.one_sided == 0 &&
         faces.unmarked == 0 && faces.parts == regions;
}

/// Whether the volume of the cells is that within the boundary; `polygons` are those of the surface file, if
/// any.
bool volumes_agree(const Mesh& mesh, const Faces& faces, const std::vector<Polygon>& polygons) {
  double sum = 0;
  for (const Cell& cell : mesh.cells) sum += volume_of(mesh, cell);
  const double off = std::fabs(sum - enclosed(as_polygons(mesh, faces.boundary))) / std::fabs(sum);
  const double off_surface = polygons.empty() ? 0 : std::fabs(sum - enclosed(polygons)) / std::fabs(sum);
  std::printf("volume %.12g  off the boundary's integral by %.2e, off that of the surface by %.2e\n", sum,
              off, off_surface);
  return off < 1e-9 && off_surface < 1e-9;
}

bool surface_matches(const Mesh& mesh, const Faces& faces, const std::vector<Polygon>& polygons) {
  const bool same = keys_of(mesh, polygons) == keys_of(faces.boundary);
  std::printf("surface polygons %zu %s\n", polygons.size(),
              same ? "are the boundary" : "DIFFER from the boundary");
  return same;
}

bool judge(const Options& options) {
  const Mesh mesh = read_mesh(options.mesh);
  if (mesh.cells.empty()) {
    std::puts("no cells");
    return false;
  }
  std::vector<Polygon> surface, inner;
  if (!options.surface.empty()) surface = read_polygons(options.surface);
  if (!options.inner.empty()) inner = read_polygons(options.inner);
  if (inner.empty() && !options.inner.empty()) {
    std::puts("no inner polygons");
    return false;
  }
  const Faces faces = match_faces(mesh, inner);
  bool good = cells_are_good(mesh);
  good &= faces_are_good(faces, options.regions);
  good &= volumes_agree(mesh, faces, surface);
  if (!options.surface.empty()) good &= surface_matches(mesh, faces, surface);
  if (options.surface.empty()) surface = as_polygons(mesh, faces.boundary);
  good &= on_cad_or_planar(mesh, surface, options.surfaces);
  if (!options.walls.empty()) good &= walls_match(options.walls, mesh, faces.boundary);
  print_columns(mesh, faces.columns);
  return good;
}

}  // namespace
}  // namespace layercheck

int main(int argc, char** argv) {
  const auto options = layercheck::parse({argv + 1, argv + argc});
  if (!options) {
    std::puts("usage: layercheck MESH [--surface FILE] [--inner FILE] [--walls FILE] [--regions N]");
    std::puts(
        "  [--sphere PATCH x y z radius] [--cylinder PATCH x y z ax ay az radius] [--plane PATCH x y z nx ny "
        "nz]");
    return 2;
  }
  const bool valid = layercheck::judge(*options);
  std::printf("VALID %s\n", valid ? "yes" : "NO");
  return valid ? 0 : 1;
}
