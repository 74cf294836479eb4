/// Relates the edges of a model with closed strips to those of the base model. Internal to cad/model/.
#pragma once

#include "cad/model/model.hpp"

#include <array>
#include <vector>

namespace aeroloom::cad {

/// A closed edge as one of its two faces uses it: an interval of an edge of the base model.
struct BorderPiece {
  FaceId face = no_entity;        ///< of the base model
  Coedge use;                     ///< coedge of the face along the base edge
  std::vector<double> own, base;  ///< parameters of the closed edge (ascending) and of the base edge

  double to_base(double parameter) const;
  double from_base(double parameter) const;
  /// Whether both parameters run in the same direction.
  bool is_along() const { return base.back() > base.front(); }
  double low() const { return is_along() ? base.front() : base.back(); }
};

/// What became of an edge of the base model.
struct BaseEdgeFate {
  enum class Kind : std::uint8_t { kept, closed, collapsed };
  Kind kind = Kind::kept;
  EdgeId edge = no_entity;     ///< kept: its new number
  std::vector<EdgeId> pieces;  ///< closed: in the order of the base edge's parameter
};

struct ClosedEdges {
  Model base;
  std::vector<FaceId> base_faces;                  ///< per face
  std::vector<EdgeId> base_edges;                  ///< per edge; no_entity for closed edges, which come last
  std::vector<char> moved;                         ///< per edge: its curve differs from the base model
  std::vector<std::array<BorderPiece, 2>> closed;  ///< per closed edge
  std::vector<BaseEdgeFate> fates;                 ///< per edge of the base model

  /// The side of a closed edge on a face of the base model.
  const BorderPiece& piece(EdgeId id, FaceId base_face) const;
  /// Approximate parameters on the face: those of the base edge.
  Vec2 base_uv(FaceId id, const Coedge& use, double parameter) const;
  /// The base model's triangulation, moved to the closed edges.
  Facets facets(const Model& model, FaceId id, double deflection, double angle) const;
};

/// The model without its faceted entities. It keeps the bytes of the whole model.
Model without_facets(const Model& model);

/// Appends the faceted entities of `before` to a model with closed strips that was made from
/// without_facets(before).
Model with_facets_of(const Model& before, const Model& closed);

}  // namespace aeroloom::cad
