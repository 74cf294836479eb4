/// Fills the box [-2,2]^3 less the unit ball: volume_benchmark [uniform|graded] [tetrahedra].
#include "mesh/quality.hpp"
#include "parallel/environment.hpp"
#include "parallel/timers.hpp"
#include "tests/volume/fields.hpp"
#include "tests/volume/surfaces.hpp"
#include "volume/volume_mesher.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

using namespace aeroloom;

struct Setup {
  double ball_size = 0, box_size = 0;
};

/// Sizes that give about the count asked for: 8.5 tetrahedra per cube of the size.
Setup choose_sizes(bool graded, double tetrahedra) {
  if (!graded) {
    const double size = std::cbrt(8.5 * 60 / tetrahedra);
    return {size, size};
  }
  const double size = 0.03 * std::sqrt(330e3 / tetrahedra);  // most of it lies around the ball
  return {size, 0.28};
}

struct Quality {
  double mean_ratio = 0, min_dihedral = 180;
};

Quality measure(const volume::FilledVolume& filled) {
  Quality quality;
  const auto point = [&](mesh::LocalIndex v) {
    const double* p = filled.coordinates.data() + 3 * static_cast<std::size_t>(v);
    return geometry::Vec3{p[0], p[1], p[2]};
  };
  const auto& t = filled.tetrahedra;
  for (std::size_t i = 0; i < t.size(); i += 4) {
    const auto a = point(t[i]), b = point(t[i + 1]), c = point(t[i + 2]), d = point(t[i + 3]);
    quality.mean_ratio += mesh::mean_ratio(a, b, c, d);
    quality.min_dihedral = std::min(quality.min_dihedral, mesh::dihedral_range(a, b, c, d).smallest);
  }
  quality.mean_ratio /= static_cast<double>(t.size()) / 4;
  return quality;
}

}  // namespace

int main(int argc, char** argv) {
  volume::register_volume_tasks();
  parallel::Environment environment(argc, argv);
  const bool graded = argc > 1 && std::string(argv[1]) == "graded";
  const Setup setup = choose_sizes(graded, argc > 2 ? std::atof(argv[2]) : 1e6);
  const auto surface = volume::surfaces::cube_with_ball(static_cast<int>(std::lround(4 / setup.box_size)),
                                                        static_cast<int>(std::lround(1.1 / setup.ball_size)));
  const auto field = graded ? volume::fields::around_unit_sphere(setup.ball_size, setup.box_size)
                            : volume::fields::uniform(setup.box_size);
  const double lattice_start = parallel::cpu_seconds();
  const auto lattice = volume::lattice_points(surface, field, {});
  const double lattice_seconds = parallel::cpu_seconds() - lattice_start;
  const double wall_start = parallel::wall_seconds();
  const auto filled = volume::fill_volume(surface, field, {});
  const double wall = parallel::wall_seconds() - wall_start;
  const double tetrahedra = static_cast<double>(filled.tetrahedra.size()) / 4;
  const Quality quality = measure(filled);
  std::printf(
      "RESULT sizes=%s tets=%.0f points=%zu triangles=%zu seconds=%.3f wall_seconds=%.3f "
      "tets_per_second=%.0f "
      "mean_ratio=%.4f min_dihedral=%.3f lattice_seconds=%.3f lattice_points=%zu child_bytes_per_tet=%.0f "
      "attempts=%d steiner=%lld\n",
      graded ? "graded" : "uniform", tetrahedra, filled.coordinates.size() / 3, surface.triangles.size(),
      filled.cpu_seconds, wall, tetrahedra / filled.cpu_seconds, quality.mean_ratio, quality.min_dihedral,
      lattice_seconds, lattice.size(), static_cast<double>(filled.child_peak_bytes) / tetrahedra,
      filled.attempts, static_cast<long long>(filled.steiner_points));
}
