#include "surface/piece_seed.hpp"

#include "surface/support_topology.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aeroloom::surface {

double predict_triangles(const Support& support, const sizing::SizeField& field) {
  double vertices = 0;
  for (std::size_t t = 0; t < support.triangles.size(); ++t) {
    const auto& [a, b, c] = support.triangles[t];
    const double area = norm(area_vector(support, static_cast<std::int32_t>(t)));
    // Sizes vary inside a facet that spans many elements: the middles of its edges stand for it.
    double density = 0;
    for (const auto& [p, q] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
      density += 1 / std::pow(field(0.5 * (support.points[p] + support.points[q])), 2) / 3;
    }
    vertices += 2 / std::numbers::sqrt3 * area * density;
  }
  const auto twins = geometry::match_half_edges(support.triangles);
  const auto edges =
      (static_cast<double>(twins.size()) + static_cast<double>(std::count(twins.begin(), twins.end(), -1))) /
      2;
  const double euler =
      static_cast<double>(support.points.size()) - edges + static_cast<double>(support.triangles.size());
  const auto border = static_cast<double>(support.loop_edges.size());
  const double inside = std::max(0.0, vertices - border / 2 + euler);
  return std::max(1.0, 2 * inside + border - 2 * euler);
}

parallel::Bytes pack_seed(const PieceSeed& seed) {
  parallel::Packer packer;
  packer.value(seed.load);
  packer.value(seed.support.face);
  packer.array(seed.support.points);
  packer.array(seed.support.triangles);
  packer.array(seed.support.corner_uv);
  packer.array(seed.support.mesh_vertex);
  packer.array(seed.support.loop_edges);
  packer.array(seed.vertices.points);
  packer.array(seed.vertices.uv);
  packer.array(seed.vertices.tokens);
  return packer.take();
}

PieceSeed unpack_seed(std::span<const std::byte> bytes) {
  parallel::Unpacker unpacker(bytes);
  PieceSeed seed;
  seed.load = unpacker.value<double>();
  seed.support.face = unpacker.value<cad::FaceId>();
  seed.support.points = unpacker.array<geometry::Vec3>();
  seed.support.triangles = unpacker.array<std::array<std::int32_t, 3>>();
  seed.support.corner_uv = unpacker.array<std::array<geometry::Vec2, 3>>();
  seed.support.mesh_vertex = unpacker.array<std::int32_t>();
  seed.support.loop_edges = unpacker.array<std::array<std::int32_t, 2>>();
  seed.vertices.points = unpacker.array<geometry::Vec3>();
  seed.vertices.uv = unpacker.array<geometry::Vec2>();
  seed.vertices.tokens = unpacker.array<mesh::SharedToken>();
  return seed;
}

}  // namespace aeroloom::surface
