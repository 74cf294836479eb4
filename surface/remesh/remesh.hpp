/// Local operations on the mesh of one face in space: flips, smoothing, contraction of short and division of
/// long edges.
#pragma once

#include "cad/model/model.hpp"
#include "sizing/field/size_field.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::surface {

/// The mesh of a face under work.
struct FaceMesh {
  cad::FaceId face = cad::no_entity;
  std::vector<geometry::Vec3> points;
  std::vector<geometry::Vec2> uv;                      ///< parameters of each point on the CAD surface
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< counter-clockwise seen against the outward normal
  std::int32_t fixed = 0;                              ///< the first `fixed` vertices lie on borders and stay
  /// A vertex inside of the face that is a vertex of the CAD model (apexes.hpp).
  struct ApexVertex {
    std::int32_t at = 0;
    cad::VertexId vertex = cad::no_entity;
  };
  std::vector<ApexVertex> apexes;
};

struct Remeshing {
  int sweeps = 6;       ///< after which few vertices move still; chosen, not measured
  bool resizes = true;  ///< whether edges are divided and contracted
};

/// Smooths and reconnects the interior: edges longer than 1.4 times the local size are divided, shorter than
/// 0.65 times contracted, edges flip where that raises the smaller angle, free vertices move and return to
/// the CAD surface by projection. A change that would fold the surface is not made, nor one that lowers the
/// worst mean ratio around it, unless that stays above 0.65. Edges used by one triangle stay, and so do
/// vertices on them and the first `fixed` ones. After the first sweep only places that changed are looked at
/// again. Deterministic.
void remesh_interior(const cad::Model& model, const sizing::SizeField& field, const Remeshing& options,
                     FaceMesh& mesh);

}  // namespace aeroloom::surface
