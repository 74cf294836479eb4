/// Smoothing: moves one vertex to improve the worst tetrahedron around it.
#pragma once

#include "improve/limits/change_limits.hpp"
#include "improve/tets/tet_mesh.hpp"

#include <vector>

namespace aeroloom::improve {

/// The set of positions that a point may take.
class Locus {
public:
  virtual ~Locus() = default;
  /// The part of a direction along which the point may move.
  virtual Vec3 admissible(Vec3 direction) const = 0;
  /// Moves p to the nearest admissible position. False if there is none.
  virtual bool project(Vec3& p) = 0;
};

/// All of space.
class Space final : public Locus {
public:
  Vec3 admissible(Vec3 direction) const override { return direction; }
  bool project(Vec3&) override { return true; }
};

/// The cones from one free point to a set of triangles, and the point with the best worst cone.
class ConeOptimiser {
public:
  /// Removes all cones.
  void clear() { _bases.clear(); }
  /// Adds the cone on triangle (a,b,c), which is counter-clockwise seen from the free point.
  void add(Vec3 a, Vec3 b, Vec3 c) { _bases.push_back({a, b, c}); }
  bool empty() const { return _bases.empty(); }

  /// The worst quality with the free point at p. If it is not above `floor`, returns some value not above
  /// `floor`. Triangles that decided move to the front of the list.
  double worst(const mesh::TetQuality& measure, Vec3 p, double floor);

  /// Improves the point from p, which is on the locus and has worst quality `quality`. First tries the mean
  /// of the triangles' corners. Then follows the steepest ascent of the worst qualities (Freitag and
  /// Ollivier-Gooch, Int. J. Numer. Meth. Engng 40, 1997,
  /// doi:10.1002/(SICI)1097-0207(19971115)40:21<3979::AID-NME251>3.0.CO;2-9). Moves p and returns its worst
  /// quality.
  double optimise(const mesh::TetQuality& measure, Vec3& p, double quality, Locus& locus);
  double optimise(const mesh::TetQuality& measure, Vec3& p, double quality) {
    Space space;
    return optimise(measure, p, quality, space);
  }

private:
  struct Base {
    Vec3 a, b, c;
  };
  double climb(const mesh::TetQuality& measure, Vec3& p, double quality, Locus& locus);
  double worst_on(const mesh::TetQuality& measure, Vec3& p, double floor, Locus& locus);
  Vec3 ascent_direction(const mesh::TetQuality& measure, Vec3 p, double quality, double probe,
                        const Locus& locus);
  double mean_distance(Vec3 p) const;

  std::vector<Base> _bases;
  std::vector<Vec3> _gradients;
};

/// Smooths single vertices of a mesh.
class Smoothing {
public:
  explicit Smoothing(const ChangeLimits& limits) : _limits(limits) {}

  static constexpr double least_gain = 1e-3;  ///< smallest change of quality that counts as a gain

  /// Moves a vertex with the given star on the locus, if this raises the worst quality by `gain`.
  bool smooth_on(TetMesh& mesh, LocalIndex vertex, const std::vector<LocalIndex>& star, Locus& locus,
                 double gain = least_gain);
  /// Whether such a gain is possible on the locus.
  bool promises(const TetMesh& mesh, LocalIndex vertex, const std::vector<LocalIndex>& star, Locus& locus,
                double gain);
  /// Smooths a vertex that may move freely; `star` receives its tetrahedra.
  bool smooth(TetMesh& mesh, LocalIndex vertex, std::vector<LocalIndex>& star);

private:
  double collect_cones(const TetMesh& mesh, LocalIndex vertex, const std::vector<LocalIndex>& star);

  const ChangeLimits& _limits;
  ConeOptimiser _cones;
};

}  // namespace aeroloom::improve
