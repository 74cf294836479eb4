/// Relates joined faces to their members. Internal to cad/model/.
#pragma once

#include "cad/model/model.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace aeroloom::cad {

class SheetInterior;

/// The parameter plane of a member inside that of the joined face.
struct Sheet {
  FaceId face = no_entity;
  double low = 0, high = 0;  ///< range of u in the joined plane
  double shift = 0;          ///< shift of u from the member's plane to the joined plane
  std::shared_ptr<const SheetInterior> interior =
      {};  ///< in the member's plane; only if there are several sheets
};

/// A point on an edge between two sheets.
struct SheetBorder {
  Vec3 point;
  std::array<std::int32_t, 2> sheets;
  std::array<Vec2, 2> uv;  ///< in the members' planes
};

struct JoinedFace {
  struct Use {
    Coedge use, base;  ///< as numbered by the joined face, and by the member
    std::int32_t sheet;
  };
  std::vector<Sheet> sheets;
  std::vector<Use> uses;             ///< sorted by (edge, use); only if there are several sheets
  std::vector<SheetBorder> borders;  ///< along edges between sheets

  std::int32_t sheet_at(Vec2 uv) const;
  Vec2 to_member(std::int32_t sheet, Vec2 uv) const { return {uv.x - sheets[sheet].shift, uv.y}; }
  Vec2 from_member(std::int32_t sheet, Vec2 uv) const;
  const Use& use(const Coedge& wanted) const;
  /// A sheet and the point where it is entered, in its own plane.
  struct Entry {
    std::int32_t sheet;
    Vec2 uv;
  };
  /// Crosses the border of a sheet that is nearest to a point, to a sheet not yet seen. Empty if there is
  /// none.
  std::optional<Entry> cross_border(std::int32_t sheet, Vec3 point, const std::vector<char>& seen) const;
};

/// The faces of a model with joined faces.
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
  /// Calls a function of the base model at a point of a face's parameter plane.
  template <class Result>
  Result evaluate(Result (Model::*function)(FaceId, Vec2) const, FaceId id, Vec2 uv) const {
    const Place at = locate(id, uv);
    return (base.*function)(at.face, at.uv);
  }
  Projection project(FaceId id, Vec3 point, Vec2 guess) const;
  Facets facets(FaceId id, double deflection, double angle, Model::Keep keep) const;
};

}  // namespace aeroloom::cad
