/// How the edges of a model with closed strips lead to those of the model before. Seen by this folder only.
#pragma once

#include "cad/model/model.hpp"

#include <array>
#include <vector>

namespace aeroloom::cad {

/// A closed edge as one of its two faces has it: part of an edge of the base model.
struct BorderPiece {
  FaceId face = no_entity;        ///< of the base model
  Coedge use;                     ///< the face's coedge along the base model's edge
  std::vector<double> own, base;  ///< parameters of the closed edge, ascending, and of the base model's

  double to_base(double parameter) const;
  double from_base(double parameter) const;
  /// The base model's parameters run the same way.
  bool is_along() const { return base.back() > base.front(); }
  double low() const { return is_along() ? base.front() : base.back(); }
};

/// The fate of an edge of the base model.
struct BaseEdgeFate {
  enum class Kind : std::uint8_t { kept, closed, collapsed };
  Kind kind = Kind::kept;
  EdgeId edge = no_entity;     ///< kept: its number now
  std::vector<EdgeId> pieces;  ///< closed: in the order of the base model's parameter
};

struct ClosedEdges {
  Model base;
  std::vector<FaceId> base_faces;                  ///< per face
  std::vector<EdgeId> base_edges;                  ///< per edge; no_entity for closed ones, which come last
  std::vector<char> moved;                         ///< per edge: the curve is not that of the base model
  std::vector<std::array<BorderPiece, 2>> closed;  ///< per closed edge
  std::vector<BaseEdgeFate> fates;                 ///< per edge of the base model

  /// The part of a closed edge that lies on a face of the base model.
  const BorderPiece& piece(EdgeId id, FaceId base_face) const;
  /// A guess of parameters on the face: those of the base model's edge.
  Vec2 base_uv(FaceId id, const Coedge& use, double parameter) const;
  /// The base model's triangulation drawn to the closed edges.
  Facets facets(const Model& model, FaceId id, double deflection, double angle) const;
};

/// The faces, edges and vertices of the shape alone. It has the bytes of the whole model.
Model without_facets(const Model& model);

/// A model with closed strips, made of without_facets(before), and behind its faces those of facets of the
/// model before.
Model with_facets_of(const Model& before, const Model& closed);

}  // namespace aeroloom::cad
