/// Makes sources from the sizes that a case requests at places and on patches of a model.
#pragma once

#include "sizing/choice/sampled_model.hpp"
#include "sizing/sources/size_requests.hpp"
#include "sizing/sources/surface_request.hpp"

#include <utility>
#include <vector>

namespace aeroloom::sizing {

/// Which requests count: what regions and wakes ask for comes on top of a target.
enum class Requests : bool { all, aimed };

/// Finds the sources of SizeRequests on one model. Its functions take that model as an argument.
class RequestSampler {
public:
  /// The model must have the patches that are named. Collective. Throws std::invalid_argument where the model
  /// has no walls, wakes or edges that a request names.
  RequestSampler(const SampledModel& sampled, SizeRequests requests);
  /// For the same model with some faces joined.
  RequestSampler(RequestSampler&& before, const SampledModel& joined);

  /// Replaces the requested lines. Every rank gives the same.
  void set_lines(std::vector<SizeLine> lines) { _requests.lines = std::move(lines); }

  /// Whether any request comes on top of a target.
  bool add_to_target() const { return !_requests.regions.empty() || !_requests.wakes.empty(); }
  /// The options that hold on a face. The size of its patch, if there is one, replaces larger ones.
  SizingOptions options_on(const SampledModel& sampled, cad::FaceId face, const SizingOptions& options) const;
  /// The sources of this rank for all requests but those of patches. All sizes are `coarsening` times as
  /// large. Collective, as what follows. Throws std::invalid_argument where the memory cannot hold them.
  std::vector<SizeSource> sample(const SampledModel& sampled, const SizingOptions& options, double coarsening,
                                 Requests which) const;
  /// Whether the requests clearly take more than `most` cells.
  bool ask_for_more_cells(const SampledModel& sampled, const SizingOptions& options, double coarsening,
                          Requests which, double most) const;

private:
  /// Makes triangles of the requested walls, wakes and edges.
  void lay_surfaces(const SampledModel& sampled);
  std::vector<SizeSource> sample_regions(const SampledModel& sampled, double coarsening,
                                         Requests which) const;
  /// The sources of the formula, and those of walls, wakes and edges. Each of these ends early with one more
  /// than `most` sources.
  std::vector<SizeSource> sample_cells(const SampledModel& sampled, const SizingOptions& options,
                                       double coarsening, Requests which, double most) const;

  SizeRequests _requests;
  std::vector<double> _asked_on_faces;  // sizes of their patches; 0: none
  std::vector<SurfaceRequest> _surfaces, _wakes;
};

}  // namespace aeroloom::sizing
