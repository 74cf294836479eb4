#include "sizing/choice/gap_search.hpp"

#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/log.hpp"
#include "parallel/observation/progress.hpp"
#include "parallel/observation/timers.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace aeroloom::sizing {
namespace {

using cad::FaceId;
using parallel::ScopedCpu;

// Gaps that are looked for, and the shortest edge of the facets rays start from, as parts of the body's
// extent. Chosen, not measured.
constexpr double narrow_gap = 20, finest_gap = 400;
// How many rays all faces together may take, about. This bound and those below are listed in docs/bounds.md;
// chosen, not measured.
constexpr double most_rays = 2e6;
// Rays that look closer at open gaps, besides.
constexpr std::int64_t most_close_rays = 600'000;
// Nodes of trees that all searches may visit: rays of all faces, and those that look closer.
constexpr std::int64_t most_nodes = 300'000'000, most_close_nodes = 100'000'000;
// How often what some faces leave of that is given to those that need more, and the least part of it that is
// worth it. docs/bounds.md has what that comes to; chosen, not measured.
constexpr int most_gap_rounds = 4, most_close_rounds = 8;
constexpr double least_left = 0.02;
/// Weights of faces are whole numbers that add up to this: a face with a millionth still gets millions of
/// nodes.
constexpr double all_weights = 3e12;
/// Rays that are farther apart than this many times the finest that is wanted are told of. Chosen, not
/// measured.
constexpr double coarser_than_wanted = 1.5;
/// In place of an area of nothing.
constexpr double least_area = 1e-300;

/// The shortest edge of the facets that rays start from, where all faces would need it.
double finest_facet(double extent, double area) {
  return std::max(extent / finest_gap, std::sqrt(rays_per_area * area / most_rays));
}

double longest_side(const Triangle& t) {
  return longest_edge(t).length;
}

/// The largest of the parts of a face that were not looked at, the first one of several, or a narrow one that
/// was not looked at closely enough.
std::optional<UnseenGaps> describe_unseen(FaceId face, const Gaps& gaps, double layers) {
  const auto largest = std::max_element(
      gaps.unseen.begin(), gaps.unseen.end(),
      [](const auto& a, const auto& b) { return longest_side(a.triangle) < longest_side(b.triangle); });
  const Gaps::Part* coarsest = find_coarsest(gaps, layers);
  if (largest == gaps.unseen.end() && coarsest == nullptr) return std::nullopt;
  const Triangle& t = largest == gaps.unseen.end() ? coarsest->triangle : largest->triangle;
  return UnseenGaps{face, (t[0] + t[1] + t[2]) / 3, longest_side(t)};
}

/// A face whose gaps are looked for.
struct FaceSearch {
  FaceId face;
  Gaps* gaps;
  FaceGapSearch search;
  std::int64_t weight;  ///< of `all_weights`
};

/// Of all work: a third the same for each face, a third by area, a third by facets.
std::int64_t weight_of_face(double faces, double area_part, double facet_part) {
  return std::llround(all_weights / 3 * (1 / faces + area_part + facet_part));
}

/// Looks until everything was looked at or the work is done. Collective.
void search_faces(const SampledModel& sampled, std::vector<FaceSearch>& searches) {
  const parallel::Communicator& communicator = sampled.communicator();
  parallel::Progress progress("sizing", static_cast<std::int64_t>(searches.size()),
                              "faces searched for gaps");
  const auto is_done = [](const FaceSearch& each) { return each.gaps->unseen.empty(); };
  std::int64_t left = most_nodes;
  for (int round = 0; round < most_gap_rounds && left > least_left * most_nodes; ++round) {
    std::int64_t wanting = 0, visited = 0;
    for (const FaceSearch& each : searches) wanting += round == 0 || !is_done(each) ? each.weight : 0;
    wanting = communicator.sum(wanting);
    if (wanting == 0) break;
    const double nodes_per_weight =
        static_cast<double>(left) / (round == 0 ? all_weights : static_cast<double>(wanting));
    parallel::collectively(communicator, ScopedCpu::As::task, [&] {
      for (FaceSearch& each : searches) {
        if (round > 0 && is_done(each)) continue;
        visited +=
            each.search.go_on(std::llround(nodes_per_weight * static_cast<double>(each.weight)), *each.gaps);
        if (is_done(each)) progress.advance(1, 1);
      }
    });
    left -= communicator.sum(visited);
    parallel::log_verbose(
        fmt::format("sizing: gaps: {:.3g} nodes visited", static_cast<double>(most_nodes - left)));
  }
}

/// In the open gaps of those faces. Gaps may turn out to be narrower than was seen before: what some faces
/// leave goes to where the narrow parts are by then. Collective.
void look_closer(const SampledModel& sampled, double layers, std::vector<FaceSearch>& searches) {
  const parallel::Communicator& communicator = sampled.communicator();
  std::int64_t rays_left = most_close_rays, nodes_left = most_close_nodes;
  const auto is_worth_it = [&] {
    return rays_left > least_left * most_close_rays && nodes_left > least_left * most_close_nodes;
  };
  for (int round = 0; round < most_close_rounds && is_worth_it(); ++round) {
    std::int64_t rays = 0, faces = 0;
    for (const FaceSearch& each : searches) {
      rays += count_rays(*each.gaps, layers);
      faces += each.gaps->narrow.empty() ? 0 : 1;
    }
    rays = communicator.sum(rays);
    faces = communicator.sum(faces);
    if (faces == 0) break;
    const auto wanted = static_cast<double>(std::max<std::int64_t>(1, rays));
    const double apart = std::max(1.0, std::sqrt(wanted / static_cast<double>(rays_left)));
    std::int64_t shot = 0, visited = 0;
    parallel::collectively(communicator, ScopedCpu::As::task, [&] {
      for (FaceSearch& each : searches) {
        if (each.gaps->narrow.empty()) continue;
        // Half of it the same for each face, half by what is to be looked at.
        const double part = 0.5 * (1 / static_cast<double>(faces) +
                                   static_cast<double>(count_rays(*each.gaps, layers)) / wanted);
        const LookedAt most{std::llround(part * static_cast<double>(rays_left)),
                            std::llround(part * static_cast<double>(nodes_left))};
        const LookedAt took = each.search.look_closer(apart, most, *each.gaps);
        shot += took.rays;
        visited += took.nodes;
      }
    });
    shot = communicator.sum(shot);
    if (shot == 0) break;
    rays_left -= shot;
    nodes_left -= communicator.sum(visited);
    parallel::log_verbose(fmt::format("sizing: gaps: {} faces looked at closer, {} rays", faces, shot));
  }
}

}  // namespace

GapDemand gap_demand(const SizingOptions& options) {
  const double thin = options.proximity >= 0 ? options.proximity : 1;
  return {std::max(thin, elements_across_gaps(options)), options.proximity > 0};
}

GapSearch::GapSearch(const SampledModel& sampled, GapDemand demand) : _demand(demand) {
  measure(sampled, Notes::log);
}

GapSearch::GapSearch(GapSearch&& before, const SampledModel& joined) : _demand(before._demand) {
  const cad::Model& model = joined.model();
  const auto is_joined = [&](FaceId other) { return model.sheet_count(other) > 1; };
  for (const SampledFace& face : joined.own_faces()) {
    if (is_joined(face.id)) continue;
    // Between walls that meet in an edge there is no gap: neighbours that were joined share more edges.
    const bool neighbours_joined =
        std::any_of(face.facets.boundary.begin(), face.facets.boundary.end(), [&](const auto& line) {
          const std::vector<FaceId>& users = model.edge(line.use.edge).faces;
          return std::any_of(users.begin(), users.end(), is_joined);
        });
    auto gaps = before._gaps.extract(model.members(face.id).front());
    if (neighbours_joined || gaps.empty()) continue;
    gaps.key() = face.id;
    _gaps.insert(std::move(gaps));
  }
  measure(joined, Notes::none);
}

void GapSearch::measure(const SampledModel& sampled, Notes notes) {
  const cad::Model& model = sampled.model();
  const geometry::Vec3 size = sampled.body_box().size();
  const double extent = std::max({size.x, size.y, size.z});
  std::int64_t facets = 0;
  for (const SampledFace& face : sampled.own_faces())
    facets += model.is_far_field(face.id) ? 0 : static_cast<std::int64_t>(face.facets.triangles.size());
  const auto all_facets = static_cast<double>(std::max<std::int64_t>(1, sampled.communicator().sum(facets)));
  std::vector<FaceSearch> searches;
  parallel::agree(sampled.communicator(), [&] {
    double area = 0, count = 0;
    for (FaceId f = 0; f < model.face_count(); ++f) {
      if (!model.is_far_field(f)) area += sampled.area(f), ++count;
    }
    const double finest = finest_facet(extent, area);
    if (notes == Notes::log && _demand.layers > 0 && finest > coarser_than_wanted * extent / finest_gap) {
      parallel::log_info(
          fmt::format("sizing: gaps are looked for every {:.3g} of the surface; finer looking would take too "
                      "many rays",
                      finest));
    }
    const ScopedCpu cpu(ScopedCpu::As::task);
    const GapLimits limits{extent / narrow_gap, finest, _demand.layers, _demand.thin_by_width};
    for (const SampledFace& face : sampled.own_faces()) {
      if (_demand.layers <= 0 || model.is_far_field(face.id)) continue;
      const auto [gaps, is_new] = _gaps.try_emplace(face.id);
      if (!is_new) continue;
      searches.push_back({face.id,
                          &gaps->second,
                          {model, face.id, face.facets, sampled.facets(), limits},
                          weight_of_face(count, sampled.area(face.id) / std::max(area, least_area),
                                         static_cast<double>(face.facets.triangles.size()) / all_facets)});
    }
  });
  search_faces(sampled, searches);
  look_closer(sampled, _demand.layers, searches);
  gather(sampled);
}

void GapSearch::gather(const SampledModel& sampled) {
  double narrowest = std::numeric_limits<double>::infinity();
  std::vector<UnseenGaps> mine;
  for (const auto& [face, gaps] : _gaps) {
    for (const Gap& gap : gaps.open) narrowest = std::min(narrowest, gap.width);
    if (const auto unseen = describe_unseen(face, gaps, _demand.layers)) mine.push_back(*unseen);
  }
  _narrowest_gap = sampled.communicator().minimum(narrowest);
  _unseen_gaps = sampled.communicator().gather_sorted(mine, &UnseenGaps::face);
}

}  // namespace aeroloom::sizing
