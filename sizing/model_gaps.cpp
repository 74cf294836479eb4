// Gaps between the faces of a model: what ModelSampler looks for once, before any sizes.
#include "parallel/collective_error.hpp"
#include "parallel/log.hpp"
#include "sizing/model_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace aeroloom::sizing {
namespace {

using cad::FaceId;
using parallel::ScopedCpu;

// Gaps that are looked for, and the shortest edge of the facets rays start from, as parts of the body's
// extent.
constexpr double narrow_gap = 20, finest_gap = 400;
// How many rays all faces together may take, about.
constexpr double most_rays = 2e6;
// And those that look closer at open gaps.
constexpr double most_close_rays = 3e5;

/// The shortest edge of the facets that rays start from, where all faces would need it.
double finest_facet(double extent, double area) {
  return std::max(extent / finest_gap, std::sqrt(rays_per_area * area / most_rays));
}

}  // namespace

void ModelSampler::measure_gaps(Notes notes) {
  const geometry::Vec3 size = _body_box.size();
  const double extent = std::max({size.x, size.y, size.z}), widest = extent / narrow_gap;
  std::vector<OwnFace*> looked_at;
  parallel::agree(_communicator, [&] {
    double area = 0;
    for (FaceId f = 0; f < _model.face_count(); ++f) area += _model.is_far_field(f) ? 0 : _areas[f];
    const double finest = finest_facet(extent, area);
    if (notes == Notes::tell && _layers > 0 && finest > 1.5 * extent / finest_gap) {
      parallel::log_info(
          fmt::format("sizing: gaps are looked for every {:.3g} of the surface; finer looking would take too "
                      "many rays",
                      finest));
    }
    ScopedCpu cpu(_clock, ScopedCpu::As::task);
    for (OwnFace& face : _faces) {
      if (_layers <= 0 || face.gaps || _model.is_far_field(face.id)) continue;
      face.gaps = find_gaps(_model, face.id, face.facets, *_walls, widest, finest, _layers);
      looked_at.push_back(&face);
    }
  });
  look_closer(looked_at, widest);
}

void ModelSampler::look_closer(const std::vector<OwnFace*>& faces, double widest) {
  std::int64_t rays = 0;
  for (const OwnFace* face : faces) rays += count_rays(*face->gaps, _layers);
  const double apart =
      std::max(1.0, std::sqrt(static_cast<double>(_communicator.sum(rays)) / most_close_rays));
  double narrowest = std::numeric_limits<double>::infinity();
  parallel::agree(_communicator, [&] {
    ScopedCpu cpu(_clock, ScopedCpu::As::task);
    for (OwnFace* face : faces)
      sizing::look_closer(_model, face->id, face->facets, *_walls, widest, _layers, apart, *face->gaps);
    for (const OwnFace& face : _faces) {
      if (!face.gaps) continue;
      for (const Gap& gap : face.gaps->open) narrowest = std::min(narrowest, gap.width);
    }
  });
  _narrowest_gap = _communicator.minimum(narrowest);
}

}  // namespace aeroloom::sizing
