#include "boundary.hpp"

#include <cstdio>

#include <vtkAbstractArray.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkVariant.h>
#include <vtkXMLPPolyDataReader.h>
#include <vtkXMLPolyDataReader.h>

namespace layercheck {
namespace {

template <class Reader>
std::vector<Polygon> read_with(const std::string& file) {
  vtkNew<Reader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkPolyData* const data = reader->GetOutput();
  auto* const patch = data->GetCellData()->GetArray("patch");
  vtkAbstractArray* const names = data->GetFieldData()->GetAbstractArray("patch_names");
  std::vector<Polygon> polygons(data->GetNumberOfCells());
  vtkNew<vtkIdList> ids;
  for (vtkIdType i = 0; i < data->GetNumberOfCells(); ++i) {
    Polygon& polygon = polygons[i];
    data->GetCellPoints(i, ids);
    polygon.corners.resize(ids->GetNumberOfIds());
    for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k)
      data->GetPoint(ids->GetId(k), polygon.corners[k].data());
    const auto number = patch ? static_cast<vtkIdType>(patch->GetTuple1(i)) : -1;
    if (names && number >= 0 && number < names->GetNumberOfValues())
      polygon.patch = names->GetVariantValue(number).ToString();
  }
  return polygons;
}

/// Distance of the corners of a quadrilateral from a plane, over its longer diagonal.
double bend(const std::vector<Point>& q) {
  const Point a = q[2] - q[0], b = q[3] - q[1], normal = cross(a, b);
  return std::fabs(dot(q[1] - q[0], normal)) / (length(normal) * std::max(length(a), length(b)));
}

bool in_coordinate_plane(const std::vector<Point>& corners) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::all_of(corners.begin(), corners.end(),
                    [&](const Point& p) { return p[axis] == corners[0][axis]; }))
      return true;
  }
  return false;
}

double diagonal_of(const Mesh& mesh) {
  Point low = mesh.points.front(), high = low;
  for (const Point& p : mesh.points) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  }
  return length(high - low);
}

}  // namespace

int numbers_of(const std::string& kind) {
  return kind == "sphere" ? 4 : kind == "cylinder" ? 7 : kind == "plane" ? 6 : 0;
}

double distance(const CadSurface& surface, const Point& point) {
  const std::vector<double>& n = surface.numbers;
  const Point from = point - Point{n[0], n[1], n[2]};
  if (surface.kind == "sphere") return std::fabs(length(from) - n[3]);
  const Point direction{n[3], n[4], n[5]};
  if (surface.kind == "plane") return std::fabs(dot(from, direction)) / length(direction);
  return std::fabs(length(cross(from, direction)) / length(direction) - n[6]);
}

std::vector<Polygon> read_polygons(const std::string& file) {
  return file.ends_with(".pvtp") ? read_with<vtkXMLPPolyDataReader>(file)
                                 : read_with<vtkXMLPolyDataReader>(file);
}

std::vector<Polygon> as_polygons(const Mesh& mesh, const std::vector<CellFace>& faces) {
  std::vector<Polygon> polygons(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    for (int k = 0; k < faces[i].corners; ++k) polygons[i].corners.push_back(mesh.points[faces[i].loop[k]]);
  }
  return polygons;
}

std::vector<FaceKey> keys_of(const Mesh& mesh, const std::vector<Polygon>& polygons) {
  std::vector<FaceKey> keys;
  for (const Polygon& polygon : polygons) {
    FaceKey key{-1, -1, -1, -1};
    if (polygon.corners.size() > key.size()) key.fill(-2);
    for (std::size_t k = 0; k < polygon.corners.size() && key.back() != -2; ++k) {
      const auto found = std::lower_bound(mesh.points.begin(), mesh.points.end(), polygon.corners[k]);
      const bool there = found != mesh.points.end() && *found == polygon.corners[k];
      key[k] = there ? found - mesh.points.begin() : -2;
    }
    keys.push_back(in_order(key));
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}

std::vector<FaceKey> keys_of(const std::vector<CellFace>& faces) {
  std::vector<FaceKey> keys;
  for (const CellFace& face : faces) keys.push_back(face.key);
  std::sort(keys.begin(), keys.end());
  return keys;
}

double enclosed(const std::vector<Polygon>& polygons) {
  if (polygons.empty()) return 0;
  const Point origin = polygons[0].corners[0];
  double sum = 0;
  for (const Polygon& polygon : polygons) {
    const auto& p = polygon.corners;
    if (p.size() == 3) sum += volume(origin, p[0], p[1], p[2]);
    if (p.size() != 4) continue;
    // The mean of both triangulations.
    for (int k = 0; k < 4; ++k) sum += 0.5 * volume(origin, p[k], p[(k + 1) % 4], p[(k + 2) % 4]);
  }
  return sum;
}

bool on_cad_or_planar(const Mesh& mesh, const std::vector<Polygon>& polygons,
                      const std::vector<CadSurface>& surfaces) {
  const double diagonal = diagonal_of(mesh);
  long bent = 0, quadrilaterals = 0, off = 0;
  double farthest = 0, most_bent = 0;
  std::vector<long> met(surfaces.size());
  for (const Polygon& polygon : polygons) {
    bool told = false;
    std::vector<double> nearest(polygon.corners.size(), 2 * diagonal);
    for (std::size_t s = 0; s < surfaces.size(); ++s) {
      if (surfaces[s].patch != polygon.patch) continue;
      told = true;
      ++met[s];
      for (std::size_t k = 0; k < nearest.size(); ++k)
        nearest[k] = std::min(nearest[k], distance(surfaces[s], polygon.corners[k]) / diagonal);
    }
    if (polygon.corners.size() == 4 && !told) {
      const double by = bend(polygon.corners);
      bent += !(by <= 1e-9);
      most_bent = std::max(most_bent, by);
    }
    if (!told) continue;
    const double worst = *std::max_element(nearest.begin(), nearest.end());
    quadrilaterals += polygon.corners.size() == 4;
    off += !(worst <= 1e-9);
    farthest = std::max(farthest, worst);
  }
  const long unmet = std::count(met.begin(), met.end(), 0);
  std::printf("boundary quadrilaterals not planar %ld (at most %.2g)\n", bent, most_bent);
  if (!surfaces.empty()) {
    std::printf("on CAD surfaces: quadrilaterals %ld, polygons off them %ld (at most %.2g of the diagonal), ",
                quadrilaterals, off, farthest);
    std::printf("surfaces of no polygon %ld\n", unmet);
  }
  return bent == 0 && off == 0 && unmet == 0;
}

long covered_by_triangles(const std::vector<CellFace>& boundary) {
  const std::vector<FaceKey> keys = keys_of(boundary);
  const auto has = [&](Index a, Index b, Index c) {
    return std::binary_search(keys.begin(), keys.end(), in_order({a, b, c, -1}));
  };
  long count = 0;
  for (const CellFace& face : boundary) {
    if (face.corners != 4) continue;
    const auto& q = face.loop;
    count +=
        (has(q[0], q[1], q[2]) && has(q[0], q[2], q[3])) || (has(q[0], q[1], q[3]) && has(q[1], q[2], q[3]));
  }
  return count;
}

bool walls_match(const std::string& file, const Mesh& mesh, const std::vector<CellFace>& boundary) {
  const std::vector<Polygon> bare = read_polygons(file);
  const double reference = std::fabs(enclosed(bare)), ours = std::fabs(enclosed(as_polygons(mesh, boundary)));
  const std::vector<FaceKey> keys = keys_of(boundary);
  long missing = 0, curved = 0;
  for (const Polygon& polygon : bare) {
    if (std::binary_search(keys.begin(), keys.end(), keys_of(mesh, {polygon})[0])) continue;
    ++missing;
    curved += !in_coordinate_plane(polygon.corners);
  }
  const double off = std::fabs(reference - ours) / reference;
  std::printf(
      "walls: %zu triangles without layers, %ld of them not here, %ld of these off coordinate planes; ",
      bare.size(), missing, curved);
  std::printf("volume off by %.2e\n", off);
  return curved == 0 && off < 1e-9;
}

}  // namespace layercheck
