/// How a joined face leads to its members. Seen by this folder only.
#pragma once

#include "cad/model/model.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace aeroloom::cad {

class SheetInterior;

/// A face of the base model in the parameter plane of a joined one.
struct Sheet {
  FaceId face = no_entity;
  double low = 0, high = 0;                            ///< of u in the joined plane
  double shift = 0;                                    ///< of u from the member's plane to the joined one
  std::shared_ptr<const SheetInterior> interior = {};  ///< in the member's plane; where there are several
};

/// A point on an edge between two sheets.
struct SheetBorder {
  Vec3 point;
  std::array<std::int32_t, 2> sheets;
  std::array<Vec2, 2> uv;  ///< in the members' planes
};

struct JoinedFace {
  struct Use {
    Coedge use, base;  ///< as the joined face numbers it, and the member
    std::int32_t sheet;
  };
  std::vector<Sheet> sheets;
  std::vector<Use> uses;             ///< by (edge, use); where there are several sheets
  std::vector<SheetBorder> borders;  ///< along the edges between sheets

  std::int32_t sheet_at(Vec2 uv) const;
  Vec2 to_member(std::int32_t sheet, Vec2 uv) const { return {uv.x - sheets[sheet].shift, uv.y}; }
  Vec2 from_member(std::int32_t sheet, Vec2 uv) const;
  const Use& use(const Coedge& wanted) const;
  /// A sheet and where it is entered, in its own plane.
  struct Entry {
    std::int32_t sheet;
    Vec2 uv;
  };
  /// Across the border of a sheet nearest to a point, of those with sheets not yet seen.
  std::optional<Entry> cross_border(std::int32_t sheet, Vec3 point, const std::vector<char>& seen) const;
};

/// The faces of a model that has joined ones.
struct JoinedModel {
  /// A face of the base model and a point of its parameter plane.
  struct Place {
    FaceId face;
    std::int32_t sheet;
    Vec2 uv;
  };

  Model base;
  std::vector<JoinedFace> faces;

  Place locate(FaceId id, Vec2 uv) const;
  /// What the base model answers at a point of a face's parameter plane.
  template <class Answer>
  Answer ask(Answer (Model::*question)(FaceId, Vec2) const, FaceId id, Vec2 uv) const {
    const Place at = locate(id, uv);
    return (base.*question)(at.face, at.uv);
  }
  Projection project(FaceId id, Vec3 point, Vec2 guess) const;
  Facets facets(FaceId id, double deflection, double angle, Model::Keep keep) const;
};

}  // namespace aeroloom::cad
