/// Limits to a change beside the quality that it is made for: sizes and decent shapes.
#pragma once

#include "improve/improve_options.hpp"
#include "improve/limits/local_target.hpp"
#include "improve/tets/tet_mesh.hpp"
#include "sizing/field/size_field.hpp"

#include <limits>
#include <span>

namespace aeroloom::improve {

/// A change may make an edge longer than all that were there before it only up to 3 times the size in its
/// middle, and shorter than all only down to 0.3 times that size or, where edges are shorter because the CAD
/// is, 0.3 times their mean. Where no size field is known, every length will do.
/// Nor may it leave a tetrahedron with a mean ratio below 0.5 where none as poor was; down to 0.3 times the
/// poorest where severe cases beside strips (local_target.hpp) get better: large angles over a triangle that
/// is longer than wide need a flat tetrahedron. With full effort, beside strips by as much as the worst angle
/// gains.
class ChangeLimits {
public:
  explicit ChangeLimits(const sizing::SizeField* field = nullptr, const LocalTarget* local_target = nullptr,
                        Effort effort = Effort::reduced)
      : _field(field), _local_target(local_target), _effort(effort) {}

  /// Whether the new tetrahedra of a cavity keep to that.
  bool allow(const TetMesh& mesh, const CavityReplacement& cavity) const;
  /// Whether the tetrahedra around a vertex do once it has moved from `origin`.
  bool allow_move(const TetMesh& mesh, LocalIndex vertex, std::span<const LocalIndex> star,
                  Vec3 origin) const;

  /// The part of allow() that is about lengths of edges.
  bool allow_sizes(const TetMesh& mesh, const CavityReplacement& cavity) const;

private:
  bool allow_moved_sizes(const TetMesh& mesh, LocalIndex vertex, std::span<const LocalIndex> star,
                         Vec3 origin) const;
  struct Lengths {
    double shortest = std::numeric_limits<double>::max(), longest = 0;
    double sum = 0, count = 0;

    void add(Vec3 a, Vec3 b);
  };
  bool allow_edge(const Lengths& before, Vec3 a, Vec3 b) const;

  bool touches_narrow_region(const TetMesh& mesh, std::span<const LocalIndex> tets) const;

  const sizing::SizeField* _field;
  const LocalTarget* _local_target;
  Effort _effort;
};

}  // namespace aeroloom::improve
