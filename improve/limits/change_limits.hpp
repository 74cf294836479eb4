/// Limits on local changes: edge lengths and shapes of the new tetrahedra.
#pragma once

#include "improve/improve_options.hpp"
#include "improve/limits/local_target.hpp"
#include "improve/tets/tet_mesh.hpp"
#include "sizing/field/size_field.hpp"

#include <limits>
#include <span>

namespace aeroloom::improve {

/// Limits on edge length: a new longest edge may be at most 3 h, a new shortest edge at least 0.3 h, with h
/// the size at its midpoint. If the CAD forces shorter edges, 0.3 times the mean of the old edges replaces
/// 0.3 h. Without a size field every length is allowed.
///
/// Limits on shape: no new mean ratio may be below 0.5 unless an old one was as low. In narrow regions
/// (local_target.hpp) a severe case may lower it to 0.3 times the old one, since large angles over a
/// stretched triangle need a flat tetrahedron. With full effort every case there may lower it, to 0.5 times.
class ChangeLimits {
public:
  explicit ChangeLimits(const sizing::SizeField* field = nullptr, const LocalTarget* local_target = nullptr,
                        Effort effort = Effort::reduced)
      : _field(field), _local_target(local_target), _effort(effort) {}

  /// Whether the new tetrahedra of a cavity keep to the limits.
  bool allow(const TetMesh& mesh, const CavityReplacement& cavity) const;
  /// Whether the tetrahedra around a vertex do, after its move from `origin`.
  bool allow_move(const TetMesh& mesh, LocalIndex vertex, std::span<const LocalIndex> star,
                  Vec3 origin) const;

  /// The limits on edge length alone.
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
