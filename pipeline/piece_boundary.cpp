#include "pipeline/piece_boundary.hpp"

#include "mesh/delivery.hpp"

#include <algorithm>
#include <numeric>

namespace aeroloom::pipeline {
namespace {

using mesh::GlobalIndex;
using mesh::LocalIndex;
using mesh::Piece;

struct BoundaryVertex {
  std::int32_t part, dimension;
  GlobalIndex number;
  geometry::Vec3 point;
  std::int32_t entity, unused = 0;
};

struct BoundaryTriangle {
  std::int32_t part, face;
  GlobalIndex order;  ///< surface triangles by number, then interfaces
  GlobalIndex vertices[3];
  std::int32_t patch, interface;
};

/// What goes to the owners of parts.
class Sender {
public:
  Sender(const BoundaryMeshes& meshes, const VolumePlan& plan, const MergedParts& parts,
         const std::vector<char>& wanted)
      : _meshes(meshes), _plan(plan), _parts(parts), _wanted(wanted) {}

  void add_surface() {
    for (std::size_t p = 0; p < _meshes.surface.pieces.size(); ++p) {
      const Piece& piece = _meshes.surface.pieces[p];
      const auto& number = _meshes.numbering.vertices[p];
      for (const int side : {0, 1}) {
        _last_part.assign(piece.vertex_count(), -1);
        for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
          const std::int32_t part = wanted_root(_plan.part_of_cell[_plan.cell[p][t]][side]);
          if (part < 0) continue;
          const LocalIndex* v = piece.cell(t);
          const int second = side == 0 ? 1 : 2;
          triangles.push_back({part,
                               piece.triangle_face[t],
                               _meshes.numbering.first_cell[p] + t,
                               {number[v[0]], number[v[second]], number[v[3 - second]]},
                               piece.triangle_patch[t],
                               -1});
          for (int k = 0; k < 3; ++k) {
            if (_last_part[v[k]] == part) continue;  // most often all triangles around are of one part
            _last_part[v[k]] = part;
            vertices.push_back({part, piece.vertex_dimension[v[k]], number[v[k]], piece.point(v[k]),
                                piece.vertex_entity[v[k]]});
          }
        }
      }
    }
  }

  void add_interfaces() {
    const InterfaceMesh& mesh = _meshes.interfaces;
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
      const std::int32_t f = mesh.faces[i];
      const std::int32_t a = _parts.root(_plan.faces[f].part), b = _parts.root(_plan.faces[f].beyond);
      if (a == b) continue;
      const GlobalIndex first = _meshes.numbering.cell_count + (GlobalIndex{f} << 28);
      for (const std::int32_t part : {a, b}) {
        if (!_wanted[part]) continue;
        const int second = part == a ? 1 : 2;
        for (std::int32_t t = mesh.first_triangle[i]; t < mesh.first_triangle[i + 1]; ++t) {
          const auto& v = mesh.triangles[t].vertices;
          triangles.push_back(
              {part, -1, first + (t - mesh.first_triangle[i]), {v[0], v[second], v[3 - second]}, -1, f});
        }
        for (std::int32_t v = mesh.first_vertex[i]; v < mesh.first_vertex[i + 1]; ++v) {
          const BoundaryPoint& vertex = mesh.vertices[v];
          vertices.push_back({part, vertex.dimension, vertex.number, vertex.point, vertex.entity});
        }
      }
    }
  }

  std::vector<BoundaryVertex> vertices;
  std::vector<BoundaryTriangle> triangles;

private:
  std::int32_t wanted_root(std::int32_t part) const {
    if (part < 0) return -1;
    const std::int32_t root = _parts.root(part);
    return _wanted[root] ? root : -1;
  }

  const BoundaryMeshes& _meshes;
  const VolumePlan& _plan;
  const MergedParts& _parts;
  const std::vector<char>& _wanted;
  std::vector<std::int32_t> _last_part;
};

void append_vertices(const std::vector<BoundaryVertex>& vertices, std::vector<PieceBoundary>& boundaries) {
  for (const BoundaryVertex& v : vertices) {
    PieceBoundary& boundary = boundaries[v.part];
    if (!boundary.vertex_number.empty() && boundary.vertex_number.back() == v.number) continue;
    boundary.vertex_number.push_back(v.number);
    boundary.surface.points.push_back(v.point);
    boundary.vertex_dimension.push_back(static_cast<std::int8_t>(v.dimension));
    boundary.vertex_entity.push_back(v.entity);
  }
}

void append_triangles(const std::vector<BoundaryTriangle>& triangles,
                      std::vector<PieceBoundary>& boundaries) {
  for (const BoundaryTriangle& t : triangles) {
    PieceBoundary& boundary = boundaries[t.part];
    const auto local = [&](GlobalIndex number) {
      const auto& numbers = boundary.vertex_number;
      return static_cast<LocalIndex>(std::lower_bound(numbers.begin(), numbers.end(), number) -
                                     numbers.begin());
    };
    boundary.surface.triangles.push_back({local(t.vertices[0]), local(t.vertices[1]), local(t.vertices[2])});
    boundary.triangle_face.push_back(t.face);
    boundary.triangle_patch.push_back(t.patch);
    boundary.triangle_interface.push_back(t.interface);
  }
}

}  // namespace

MergedParts::MergedParts(std::int32_t parts) : _root(parts) {
  std::iota(_root.begin(), _root.end(), 0);
}

std::int32_t MergedParts::root(std::int32_t part) const {
  return _root[part];
}

void MergedParts::merge(std::int32_t a, std::int32_t b) {
  const std::int32_t low = std::min(_root[a], _root[b]), high = std::max(_root[a], _root[b]);
  std::replace(_root.begin(), _root.end(), high, low);
}

MergedParts merge_at_failed(const VolumePlan& plan, const InterfaceMesh& interfaces) {
  MergedParts parts(plan.parts);
  for (const std::int32_t f : interfaces.failed) parts.merge(plan.faces[f].part, plan.faces[f].beyond);
  return parts;
}

std::vector<PieceBoundary> gather_boundaries(const parallel::Communicator& communicator,
                                             const BoundaryMeshes& meshes, const VolumePlan& plan,
                                             const MergedParts& parts, const std::vector<char>& wanted,
                                             const std::vector<parallel::Rank>& owners) {
  Sender sender(meshes, plan, parts, wanted);
  sender.add_surface();
  sender.add_interfaces();
  const auto owner = [&](const auto& item) { return owners[item.part]; };
  std::vector<PieceBoundary> boundaries(plan.parts);
  {
    auto vertices = mesh::deliver(communicator, sender.vertices, owner);
    sender.vertices = {};
    std::sort(vertices.begin(), vertices.end(), [](const BoundaryVertex& a, const BoundaryVertex& b) {
      return a.part != b.part ? a.part < b.part : a.number < b.number;
    });
    append_vertices(vertices, boundaries);
  }
  auto triangles = mesh::deliver(communicator, sender.triangles, owner);
  sender.triangles = {};
  std::sort(triangles.begin(), triangles.end(), [](const BoundaryTriangle& a, const BoundaryTriangle& b) {
    return a.part != b.part ? a.part < b.part : a.order < b.order;
  });
  append_triangles(triangles, boundaries);
  return boundaries;
}

}  // namespace aeroloom::pipeline
