#include "cells.hpp"

#include <limits>
#include <numeric>

#include <vtkCellData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

namespace layercheck {
namespace {

// Faces, counter-clockwise from outside. VTK's prism has its triangle (0,1,2) facing outward.
const std::map<int, std::vector<std::vector<int>>> faces_of = {
    {tetrahedron, {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}},
    {hexahedron, {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}},
    {prism, {{0, 1, 2}, {3, 5, 4}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}}},
    {pyramid, {{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}}};

// Tetrahedra of positive volume: of a prism those of its six cuts, of the others those at corners.
const std::map<int, std::vector<std::array<int, 4>>> tetrahedra_of = {
    {tetrahedron, {{0, 1, 2, 3}}},
    {hexahedron,
     {{0, 1, 3, 4},
      {1, 2, 0, 5},
      {2, 3, 1, 6},
      {3, 0, 2, 7},
      {4, 7, 5, 0},
      {5, 4, 6, 1},
      {6, 5, 7, 2},
      {7, 6, 4, 3}}},
    {prism,
     {{0, 2, 1, 3},
      {1, 0, 2, 4},
      {2, 1, 0, 5},
      {3, 4, 5, 0},
      {4, 5, 3, 1},
      {5, 3, 4, 2},
      {0, 4, 5, 1},
      {0, 5, 2, 4},
      {1, 5, 3, 2},
      {1, 3, 0, 5},
      {2, 3, 4, 0},
      {2, 4, 1, 3}}},
    {pyramid, {{0, 1, 3, 4}, {1, 2, 0, 4}, {2, 3, 1, 4}, {3, 0, 2, 4}}}};

/// Puts the points in order, each once, and renames the nodes.
void weld(Mesh& mesh) {
  std::vector<std::size_t> order(mesh.points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return mesh.points[a] < mesh.points[b]; });
  std::vector<Index> to(mesh.points.size());
  std::vector<Point> kept;
  for (const std::size_t i : order) {
    if (kept.empty() || mesh.points[i] != kept.back()) kept.push_back(mesh.points[i]);
    to[i] = static_cast<Index>(kept.size()) - 1;
  }
  mesh.points_stored = mesh.points.size();
  mesh.points.swap(kept);
  std::vector<char> used(mesh.points.size());
  for (Cell& cell : mesh.cells) {
    for (int k = 0; k < nodes_of(cell.type); ++k) {
      cell.node[k] = to[cell.node[k]];
      used[cell.node[k]] = 1;
    }
  }
  mesh.orphans = std::count(used.begin(), used.end(), 0);
}

template <class Reader>
Mesh read_with(const std::string& file) {
  vtkNew<Reader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkUnstructuredGrid* const grid = reader->GetOutput();
  Mesh mesh;
  mesh.points.resize(grid->GetNumberOfPoints());
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    grid->GetPoint(static_cast<vtkIdType>(i), mesh.points[i].data());
  auto* const ghost = grid->GetCellData()->GetArray("vtkGhostType");
  auto* const region = grid->GetCellData()->GetArray("region");
  vtkNew<vtkIdList> ids;
  for (vtkIdType i = 0; i < grid->GetNumberOfCells(); ++i) {
    if (ghost && (static_cast<int>(ghost->GetTuple1(i)) & 1)) continue;
    const int type = grid->GetCellType(i);
    if (!faces_of.contains(type)) {
      ++mesh.other_types[type];
      continue;
    }
    grid->GetCellPoints(i, ids);
    Cell cell{type, region ? static_cast<int>(region->GetTuple1(i)) : 0, {}};
    for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k) cell.node[k] = ids->GetId(k);
    mesh.cells.push_back(cell);
  }
  weld(mesh);
  return mesh;
}

/// One half and the square root of a twelfth: where two values give the mean of a cubic function on [0, 1].
const std::array<double, 2> gauss = {0.5 - std::sqrt(1.0 / 12), 0.5 + std::sqrt(1.0 / 12)};

double volume_of_prism(const std::array<Point, 8>& p) {
  const Point up = (1.0 / 3) * ((p[3] - p[0]) + (p[4] - p[1]) + (p[5] - p[2]));
  double sum = 0;
  for (const double z : gauss) {
    const Point a = (1 - z) * (p[1] - p[0]) + z * (p[4] - p[3]);
    const Point b = (1 - z) * (p[2] - p[0]) + z * (p[5] - p[3]);
    sum += 0.25 * dot(up, cross(b, a));
  }
  return sum;
}

double volume_of_hexahedron(const std::array<Point, 8>& p) {
  double sum = 0;
  for (const double x : gauss) {
    for (const double y : gauss) {
      for (const double z : gauss) {
        const auto across = [](double s, double t, const std::array<Point, 4>& d) {
          return (1 - t) * ((1 - s) * d[0] + s * d[1]) + t * ((1 - s) * d[2] + s * d[3]);
        };
        const Point a = across(y, z, {p[1] - p[0], p[2] - p[3], p[5] - p[4], p[6] - p[7]});
        const Point b = across(x, z, {p[3] - p[0], p[2] - p[1], p[7] - p[4], p[6] - p[5]});
        const Point c = across(x, y, {p[4] - p[0], p[5] - p[1], p[7] - p[3], p[6] - p[2]});
        sum += dot(a, cross(b, c)) / 8;
      }
    }
  }
  return sum;
}

std::array<Point, 8> corners_of(const Mesh& mesh, const Cell& cell) {
  std::array<Point, 8> corners{};
  for (int k = 0; k < nodes_of(cell.type); ++k) corners[k] = mesh.points[cell.node[k]];
  return corners;
}

}  // namespace

int nodes_of(int type) {
  return type == tetrahedron ? 4 : type == pyramid ? 5 : type == prism ? 6 : 8;
}

Mesh read_mesh(const std::string& file) {
  return file.ends_with(".pvtu") ? read_with<vtkXMLPUnstructuredGridReader>(file)
                                 : read_with<vtkXMLUnstructuredGridReader>(file);
}

std::vector<CellFace> all_faces(const Mesh& mesh) {
  std::vector<CellFace> faces;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    int side = 0;
    for (const auto& corners : faces_of.at(mesh.cells[c].type)) {
      CellFace face{{}, {-1, -1, -1, -1}, static_cast<int>(corners.size()), static_cast<Index>(c), side++};
      for (int k = 0; k < face.corners; ++k) face.loop[k] = mesh.cells[c].node[corners[k]];
      face.key = in_order(face.loop);
      faces.push_back(face);
    }
  }
  std::sort(faces.begin(), faces.end(), [](const CellFace& a, const CellFace& b) { return a.key < b.key; });
  return faces;
}

bool opposite(const CellFace& a, const CellFace& b) {
  const int n = a.corners;
  for (int shift = 0; shift < n; ++shift) {
    bool match = true;
    for (int k = 0; k < n; ++k) match &= a.loop[k] == b.loop[(shift - k + n) % n];
    if (match) return true;
  }
  return false;
}

double smallest_tetrahedron(const Mesh& mesh, const Cell& cell) {
  const auto p = corners_of(mesh, cell);
  double smallest = std::numeric_limits<double>::max();
  for (const auto& t : tetrahedra_of.at(cell.type))
    smallest = std::min(smallest, volume(p[t[0]], p[t[1]], p[t[2]], p[t[3]]));
  return smallest;
}

double volume_of(const Mesh& mesh, const Cell& cell) {
  const auto p = corners_of(mesh, cell);
  if (cell.type == hexahedron) return volume_of_hexahedron(p);
  if (cell.type == prism) return volume_of_prism(p);
  if (cell.type == tetrahedron) return volume(p[0], p[1], p[2], p[3]);
  // The cone over a bilinear patch is the mean of those over its two triangulations.
  return 0.5 * (volume(p[0], p[1], p[2], p[4]) + volume(p[0], p[2], p[3], p[4]) +
                volume(p[0], p[1], p[3], p[4]) + volume(p[1], p[2], p[3], p[4]));
}

double scaled_jacobian(const Mesh& mesh, const Cell& cell) {
  const auto p = corners_of(mesh, cell);
  double worst = std::numeric_limits<double>::max();
  for (int k = 0; k < 6; ++k) {
    const bool top = k >= 3;
    const int base = top ? 3 : 0, i = k - base;
    const Point a = p[base + (i + 1) % 3] - p[k], b = p[base + (i + 2) % 3] - p[k], c = p[(k + 3) % 6] - p[k];
    const double volume = dot(a, cross(b, c)) * (top ? 1 : -1);
    worst = std::min(worst, volume / (length(a) * length(b) * length(c)) * 2 / std::sqrt(3.0));
  }
  return worst;
}

}  // namespace layercheck
