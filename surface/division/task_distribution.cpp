#include "surface/division/task_distribution.hpp"

#include "parallel/communication/schedule.hpp"
#include "parallel/observation/timers.hpp"

#include <algorithm>
#include <utility>

namespace aeroloom::surface {
namespace {

/// The cost of a piece besides its triangles, in triangles. No result depends on it. Chosen, not measured.
constexpr double piece_overhead = 150;

/// Names the cuts of a division (divide_problem): 0 for a face, others for its parts.
std::int32_t group_of(const PieceKey& key, int level) {
  return level == 1 ? 0 : key[1] + 1;
}

}  // namespace

double load_of_piece(double triangles, double facets) {
  return triangles + piece_overhead + facets;
}

struct TaskDistributor::Row {
  PieceKey key;
  double load;    // predicted triangles
  double facets;  // of the chart surface
  double cost;    // of making it, in triangles to mesh
  parallel::Rank at;
};

TaskDistributor::TaskDistributor(const parallel::Communicator& communicator, const cad::Model& model,
                                 const CutOptions& options)
    : _communicator(communicator), _model(model), _options(options), _whole(model.face_count(), 0) {}

void TaskDistributor::leave_whole(const std::vector<cad::FaceId>& faces) {
  for (const cad::FaceId face : faces) _whole[face] = 1;
}

/// One row per piece problem, on every rank, by key.
std::vector<TaskDistributor::Row> TaskDistributor::tabulate(const PieceProblems& problems,
                                                            const std::map<PieceKey, double>& costs) const {
  std::vector<Row> rows;
  for (const auto& [key, problem] : problems) {
    const auto cost = costs.find(key);
    rows.push_back(
        {key, problem.load, problem.facets(), cost == costs.end() ? 0 : cost->second, _communicator.rank()});
  }
  rows = _communicator.gather_sorted(rows, &Row::key);
  return rows;
}

/// Sends piece problems to their owners, by row.
PieceProblems TaskDistributor::send_to_owners(PieceProblems problems, const std::vector<Row>& rows,
                                              const std::vector<parallel::Rank>& owners) const {
  PieceProblems here;
  std::map<parallel::Rank, parallel::Packer> leaving;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto at = problems.find(rows[i].key);
    if (at == problems.end()) continue;
    if (owners[i] == _communicator.rank()) {
      here.emplace(rows[i].key, std::move(at->second));
      continue;
    }
    parallel::pack(leaving[owners[i]], *at);
  }
  std::vector<parallel::Parcel> parcels;
  parcels.reserve(leaving.size());
  for (auto& [rank, packer] : leaving) parcels.push_back({rank, packer.take()});
  for (const parallel::Parcel& parcel : _communicator.exchange(std::move(parcels))) {
    parallel::Unpacker unpacker(parcel.content);
    while (!unpacker.at_end()) here.insert(parallel::unpack<std::pair<PieceKey, PieceProblem>>(unpacker));
  }
  return here;
}

bool TaskDistributor::is_to_divide(const Row& row, int level) const {
  if (_whole[row.key[0]]) return false;
  return _options.divider ? level == 1 : is_heavy(row.load, _options);
}

/// Divides one piece problem; its parts join those `divided`.
void TaskDistributor::divide(PieceProblems::value_type& entry, int level, CoarseSizes& sizes,
                             PieceProblems& divided) {
  auto& [key, problem] = entry;
  const std::int32_t group = group_of(key, level);
  const double begin = parallel::cpu_seconds();
  const double load = division_cost(problem.load, problem.facets(), group, _options);
  DividedProblem pieces = divide_problem(_model, std::move(problem), group, sizes, _options);
  for (std::size_t i = 0; i < pieces.problems.size(); ++i) {
    PieceKey part = key;
    part[level] = static_cast<std::int32_t>(i);
    divided.emplace(part, std::move(pieces.problems[i]));
  }
  parallel::note_task(
      {.kind = level == 1 ? parallel::TaskKind::divided_face : parallel::TaskKind::divided_part,
       .number = key[0],
       .predicted = load,
       .cpu_seconds = parallel::cpu_seconds() - begin,
       .burden = load});
  std::vector<CutAngle>& angles = _angles[key];  // its first part has the key of the face
  angles.insert(angles.end(), pieces.angles.begin(), pieces.angles.end());
}

/// Schedules the piece problems and divides those that are too heavy; the parts stay where they were made.
PieceProblems TaskDistributor::divide_heavy(PieceProblems problems, const std::vector<Row>& rows, int level,
                                            CoarseSizes& sizes) {
  if (std::none_of(rows.begin(), rows.end(), [&](const Row& row) { return is_to_divide(row, level); }))
    return problems;
  std::vector<double> loads;
  loads.reserve(rows.size());
  for (const Row& row : rows) {
    const bool divided = is_to_divide(row, level);
    loads.push_back(divided ? division_cost(row.load, row.facets, group_of(row.key, level), _options) : 0);
  }
  auto owners = parallel::assign_largest_first(loads, _loads);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    _loads[owners[i]] += loads[i];
    // A problem that is not divided stays on its rank: nothing is sent without need.
    if (!is_to_divide(rows[i], level)) owners[i] = rows[i].at;
  }
  problems = send_to_owners(std::move(problems), rows, owners);
  PieceProblems divided;
  parallel::collectively(_communicator, parallel::ScopedCpu::As::task, [&] {
    for (auto& entry : problems) {
      if (is_to_divide({entry.first, entry.second.load, 0, 0, 0}, level)) {
        divide(entry, level, sizes, divided);
      } else {
        divided.emplace(entry.first, std::move(entry.second));
      }
    }
  });
  return divided;
}

TaskDistribution TaskDistributor::distribute(PieceProblems whole, const std::map<PieceKey, double>& costs,
                                             const sizing::SizeField& field) {
  _loads.assign(static_cast<std::size_t>(_communicator.size()), 0);
  _angles.clear();
  CoarseSizes sizes(field);
  for (const int level : {1, 2}) {
    const std::vector<Row> rows = tabulate(whole, costs);
    for (const Row& row : rows) _loads[row.at] += level == 1 ? row.cost : 0;
    whole = divide_heavy(std::move(whole), rows, level, sizes);
  }
  const std::vector<Row> rows = tabulate(whole, costs);
  TaskDistribution distribution;
  std::vector<double> loads;
  std::map<cad::FaceId, std::int32_t> parts;
  for (const Row& row : rows) {
    distribution.places[row.key] = parts[row.key[0]]++;
    loads.push_back(load_of_piece(row.load, row.facets));
  }
  distribution.problems =
      send_to_owners(std::move(whole), rows, parallel::assign_largest_first(loads, _loads));
  distribution.angles = std::move(_angles);
  return distribution;
}

}  // namespace aeroloom::surface
