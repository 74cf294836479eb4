/// Moving one vertex so that the worst of the tetrahedra around it gets better.
#pragma once

#include "improve/limits/change_limits.hpp"
#include "improve/tets/tet_mesh.hpp"

#include <vector>

namespace aeroloom::improve {

/// Where a free point may go.
class Locus {
public:
  virtual ~Locus() = default;
  /// The part of a direction along which the point may move.
  virtual Vec3 admissible(Vec3 direction) const = 0;
  /// The admissible point next to p, into p; false: there is none that will do.
  virtual bool project(Vec3& p) = 0;
};

/// Everywhere.
class Space final : public Locus {
public:
  Vec3 admissible(Vec3 direction) const override { return direction; }
  bool project(Vec3&) override { return true; }
};

/// The cones from one free point to a set of triangles, and the point that makes the worst of them best.
class ConeOptimiser {
public:
  /// Starts a set of cones.
  void clear() { _bases.clear(); }
  /// Adds the cone to triangle (a,b,c), which is counter-clockwise seen from the free point.
  void add(Vec3 a, Vec3 b, Vec3 c) { _bases.push_back({a, b, c}); }
  bool empty() const { return _bases.empty(); }

  /// The worst quality with the free point at p; where it is not above `floor`, some value not above `floor`.
  /// Bases that once decided move to the front.
  double worst(const mesh::TetQuality& measure, Vec3 p, double floor);

  /// Improves the point from p, which is on the locus, with worst quality `quality`: first towards the mean
  /// of the bases' corners, then by steepest ascent of the active qualities (Freitag and Ollivier-Gooch, Int.
  /// J. Numer. Meth. Engng 40, 1997, doi:10.1002/(SICI)1097-0207(19971115)40:21<3979::AID-NME251>3.0.CO;2-9).
  /// Returns the new worst quality and moves p.
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

  static constexpr double least_gain = 1e-3;  ///< of quality: a smaller gain does not count as one

  /// Moves a vertex on the locus, its tetrahedra given, where that lifts the worst quality around it by
  /// `gain`.
  bool smooth_on(TetMesh& mesh, LocalIndex vertex, const std::vector<LocalIndex>& star, Locus& locus,
                 double gain = least_gain);
  /// Whether there is such a gain to be had on the locus.
  bool promises(const TetMesh& mesh, LocalIndex vertex, const std::vector<LocalIndex>& star, Locus& locus,
                double gain);
  /// Smooths a vertex that may go everywhere; `star` receives its tetrahedra.
  bool smooth(TetMesh& mesh, LocalIndex vertex, std::vector<LocalIndex>& star);

private:
  double collect_cones(const TetMesh& mesh, LocalIndex vertex, const std::vector<LocalIndex>& star);

  const ChangeLimits& _limits;
  ConeOptimiser _cones;
};

}  // namespace aeroloom::improve
