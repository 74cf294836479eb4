#include "parallel/timers.hpp"
#include "volume/boundary_distance.hpp"
#include "volume/contained_fill.hpp"
#include "volume/lattice.hpp"
#include "volume/surface_check.hpp"
#include "volume/volume_mesher.hpp"

#include <sstream>

namespace aeroloom::volume {
namespace {

/// A rung of the ladder: what is done differently to get a stubborn piece filled.
struct Rung {
  const char* name;
  double clearance_factor;
  InteriorPoints interior;
  bool lattice;
};

constexpr Rung ladder[] = {
    {"lattice points given at once", 1.0, InteriorPoints::at_once, true},
    {"other perturbations of the lattice", 1.0, InteriorPoints::at_once, true},
    {"lattice farther off, inserted after the boundary", 1.6, InteriorPoints::after_recovery, true},
    {"no lattice", 1.0, InteriorPoints::at_once, false},
};
constexpr int last_rung = static_cast<int>(std::size(ladder)) - 1;

[[noreturn]] void refuse(const ClosedSurface& surface, const SurfaceDefect& defect,
                         const std::string& tried) {
  std::ostringstream text;
  text << "A volume piece of " << surface.triangles.size() << " triangles cannot be filled: " << defect.what
       << '.' << describe_triangles(surface, defect.triangles) << tried;
  throw VolumeError(text.str(), defect.triangles);
}

void refuse_above(const VolumeOptions& options, std::int64_t predicted) {
  if (predicted <= options.largest_piece) return;
  throw VolumeError(
      "A volume piece would get more than " + std::to_string(options.largest_piece) +
          " tetrahedra (VolumeOptions::largest_piece). Ask for smaller pieces (volume.piece_tets) or "
          "larger elements (sizing.minimum).",
      {});
}

/// The request of one rung. Lattice points beyond what the largest piece may have refuse the piece.
FillRequest prepare(const ClosedSurface& surface, const BoundaryDistance& boundary,
                    const sizing::SizeField& field, const VolumeOptions& options, int attempt) {
  const Rung& rung = ladder[attempt];
  FillRequest request;
  request.points = surface.points;
  request.surface_points = surface.points.size();
  request.triangles = surface.triangles;
  request.interior = rung.interior;
  request.sabotage = options.sabotage;
  if (rung.lattice) {
    const auto lattice =
        body_centred_lattice(boundary, field,
                             {rung.clearance_factor * options.lattice_clearance, options.perturbation,
                              attempt, options.largest_piece / tetrahedra_per_point + 1,
                              rung.clearance_factor * options.continued_clearance, surface.continued});
    request.interior_points = lattice.points.size();
    request.points.insert(request.points.end(), lattice.points.begin(), lattice.points.end());
    if (rung.interior == InteriorPoints::at_once) {
      request.points.insert(request.points.end(), lattice.scaffold.begin(), lattice.scaffold.end());
    }
  }
  refuse_above(options, predict_tetrahedra(request));
  return request;
}

/// The remedy belongs to the cause: a surface that meets itself cannot be helped by trying again.
void stop_if_self_intersecting(const ClosedSurface& surface, const BoundaryDistance& boundary,
                               const std::string& failure) {
  const SurfaceDefect defect = find_intersections(surface, boundary);
  if (defect.what.empty()) return;
  refuse(surface, defect,
         "\nThe mesher said: " + failure +
             "\nUse smaller elements there, so that surfaces close to each other are resolved, or "
             "repair the geometry.");
}

[[noreturn]] void give_up(const ClosedSurface& surface, const std::string& log) {
  geometry::Box box;
  for (const auto& p : surface.points) box.add(p);
  std::ostringstream place;
  place << "no way of filling it worked, between (" << box.low.x << ", " << box.low.y << ", " << box.low.z
        << ") and (" << box.high.x << ", " << box.high.y << ", " << box.high.z << ")";
  refuse(surface, {place.str(), {}},
         "\nTried:" + log + "\nUse other sizes there, or another piece size (volume.piece_tets).");
}

}  // namespace

FilledVolume fill_volume(const ClosedSurface& surface, const sizing::SizeField& field,
                         const VolumeOptions& options) {
  const double start = parallel::cpu_seconds();
  if (const SurfaceDefect defect = find_defect(surface); !defect.what.empty()) refuse(surface, defect, "");
  const BoundaryDistance boundary(surface.points, surface.triangles);
  std::string log;
  double child_seconds = 0;
  std::int64_t child_peak = 0;
  for (int attempt = 0; attempt <= std::min(options.retries, last_rung); ++attempt) {
    const FillRequest request = prepare(surface, boundary, field, options, attempt);
    FillReply reply = fill_contained(request);
    child_seconds += reply.volume.cpu_seconds;
    child_peak = std::max(child_peak, reply.volume.child_peak_bytes);
    if (reply.filled) {
      reply.volume.attempts = attempt + 1;
      reply.volume.cpu_seconds = child_seconds + parallel::cpu_seconds() - start;
      reply.volume.child_peak_bytes = child_peak;
      return std::move(reply.volume);
    }
    log += std::string("\n  ") + ladder[attempt].name + ": " + reply.failure;
    if (attempt == 0) stop_if_self_intersecting(surface, boundary, reply.failure);
  }
  give_up(surface, log);
}

}  // namespace aeroloom::volume
