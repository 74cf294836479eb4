/// The field of a model.
#include "parallel/collective_error.hpp"
#include "parallel/schedule.hpp"
#include "sizing/field_builder.hpp"
#include "sizing/model_sources.hpp"

#include <algorithm>
#include <numeric>

namespace aeroloom::sizing {
namespace {

using parallel::Communicator;

/// Areas of all faces, each measured by one rank.
std::vector<double> measure_faces(const Communicator& communicator, const geometry::Model& model) {
  std::vector<double> mine, areas(model.face_count());
  parallel::agree(communicator, [&] {
    for (geometry::FaceId f = communicator.rank(); f < model.face_count(); f += communicator.size()) {
      mine.push_back(model.face_area(f));
    }
  });
  const std::vector<double> all = communicator.all_gather_items<double>(mine);
  std::size_t next = 0;
  for (int rank = 0; rank < communicator.size(); ++rank) {
    for (geometry::FaceId f = rank; f < model.face_count(); f += communicator.size()) areas[f] = all[next++];
  }
  return areas;
}

/// What sampling a face costs, in samples: its facets, and its area over that of a small element.
std::vector<double> predict_sampling_loads(const std::vector<bool>& far_field,
                                           const std::vector<double>& areas) {
  double body_area = 0;
  for (std::size_t f = 0; f < areas.size(); ++f) body_area += far_field[f] ? 0 : areas[f];
  std::vector<double> loads(areas.size(), 1);
  for (std::size_t f = 0; f < areas.size(); ++f) {
    if (!far_field[f] && body_area > 0)
      loads[f] += 100 * static_cast<double>(areas.size()) * areas[f] / body_area;
  }
  return loads;
}

bool only_far_field(const geometry::Edge& edge, const std::vector<bool>& far_field) {
  return std::all_of(edge.faces.begin(), edge.faces.end(), [&](geometry::FaceId f) { return far_field[f]; });
}

std::vector<SizeSource> sources_of_rank(const Communicator& communicator, const geometry::Model& model,
                                        const std::vector<bool>& far_field, const std::vector<double>& loads,
                                        const SizingOptions& options, const RootCube& root) {
  std::vector<SizeSource> mine;
  const auto keep = [&](const std::vector<SizeSource>& more) {
    mine.insert(mine.end(), more.begin(), more.end());
  };
  const auto owners = parallel::assign_largest_first(loads, communicator.size());
  for (const int f : parallel::tasks_of_rank(owners, loads, communicator.rank())) {
    keep(face_sources(model, f, far_field[f], options, root));
  }
  for (geometry::EdgeId e = communicator.rank(); e < model.edge_count(); e += communicator.size()) {
    keep(edge_sources(model, e, only_far_field(model.edge(e), far_field), options));
  }
  return mine;
}

}  // namespace

SizeField build_size_field(const Communicator& communicator, const geometry::Model& model,
                           const SizingOptions& options, parallel::StageClock& clock) {
  check_options(options);
  const RootCube root(model.bounds());
  const std::vector<double> areas = measure_faces(communicator, model);
  std::vector<SizeSource> mine;
  parallel::agree(communicator, [&] {
    parallel::ScopedCpu cpu(clock, parallel::ScopedCpu::As::task);
    const std::vector<bool> far_field = find_far_field(model);
    const std::vector<double> loads = predict_sampling_loads(far_field, areas);
    mine = sources_of_rank(communicator, model, far_field, loads, options, root);
  });
  const std::vector<SizeSource> all = communicator.all_gather_items<SizeSource>(mine);
  parallel::ScopedCpu cpu(clock, parallel::ScopedCpu::As::serial);
  return FieldBuilder(model.bounds(), options).build(all);
}

}  // namespace aeroloom::sizing
