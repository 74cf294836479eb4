/// Remeshes one face in space by local operations: flips, smoothing, contraction of short edges, division of
/// long ones.
#pragma once

#include "cad/model/model.hpp"
#include "geometry/half_edges.hpp"
#include "sizing/field/size_field.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::surface {

/// The mesh of a face.
struct FaceMesh {
  cad::FaceId face = cad::no_entity;
  std::vector<geometry::Vec3> points;
  std::vector<geometry::Vec2> uv;                      ///< parameters of each point on the CAD surface
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< counter-clockwise seen against the outward normal
  std::int32_t fixed = 0;                              ///< the first `fixed` vertices lie on borders and stay
  std::vector<std::array<std::int32_t, 2>> slits =
      {};  ///< edges inside that stay, the lower vertex first, ascending
  /// A vertex inside the face that is a CAD vertex (apexes.hpp).
  struct ApexVertex {
    std::int32_t at = 0;
    cad::VertexId vertex = cad::no_entity;
  };
  std::vector<ApexVertex> apexes;

  bool is_slit(std::int32_t a, std::int32_t b) const {
    return std::binary_search(slits.begin(), slits.end(), std::array{std::min(a, b), std::max(a, b)});
  }
};

/// The opposite half-edge of each half-edge; -1 on borders and slits.
std::vector<geometry::HalfEdge> open_half_edges(const FaceMesh& mesh);

struct Remeshing {
  int sweeps = 6;       ///< after these few vertices still move; chosen, not measured
  bool resizes = true;  ///< whether edges are divided and contracted
};

/// Improves the interior. Edges longer than 1.4 times the local size are divided, edges shorter than 0.65
/// times contracted. An edge is flipped where that increases the smaller angle. Free vertices are smoothed
/// and projected to the CAD surface. No change may fold the surface, or lower the worst mean ratio around it
/// unless that stays above 0.65. Edges of one triangle and their vertices stay, and so do the first `fixed`
/// vertices. After the first sweep only places that changed are visited. Deterministic.
void remesh_interior(const cad::Model& model, const sizing::SizeField& field, const Remeshing& options,
                     FaceMesh& mesh);

}  // namespace aeroloom::surface
