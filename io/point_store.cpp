#include "io/point_store.hpp"

#include "mesh/delivery.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

namespace aeroloom::io {

using mesh::GlobalIndex;

namespace {

bool same_bits(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  });
}

}  // namespace

parallel::Rank KeyRanges::rank_of(GlobalIndex key) const {
  const auto found = std::upper_bound(first.begin(), first.end() - 1, key);
  return static_cast<parallel::Rank>(std::max<std::ptrdiff_t>(1, found - first.begin()) - 1);
}

KeyRanges even_ranges(int ranks, GlobalIndex limit) {
  KeyRanges ranges;
  const GlobalIndex width = limit / ranks + 1;
  for (int r = 0; r <= ranks; ++r) ranges.first.push_back(width * r);
  return ranges;
}

KeyRanges fair_ranges(const parallel::Communicator& communicator, std::vector<GlobalIndex> keys,
                      GlobalIndex limit) {
  constexpr GlobalIndex dense = 4, samples_per_rank = 64;
  const GlobalIndex ranks = communicator.size();
  const GlobalIndex total = communicator.sum(static_cast<std::int64_t>(keys.size()));
  if (limit / dense <= total) return even_ranges(communicator.size(), limit);
  std::sort(keys.begin(), keys.end());
  // One of so many keys on any rank, so that samples of all count the same.
  const GlobalIndex step = total / (samples_per_rank * ranks) + 1;
  std::vector<GlobalIndex> samples;
  for (GlobalIndex i = step / 2; i < static_cast<GlobalIndex>(keys.size()); i += step)
    samples.push_back(keys[static_cast<std::size_t>(i)]);
  samples = communicator.all_gather_items(std::span<const GlobalIndex>(samples));
  if (samples.empty()) return even_ranges(communicator.size(), limit);
  std::sort(samples.begin(), samples.end());
  KeyRanges ranges;
  ranges.first.push_back(0);
  for (GlobalIndex r = 1; r < ranks; ++r)
    ranges.first.push_back(
        samples[samples.size() * static_cast<std::size_t>(r) / static_cast<std::size_t>(ranks)]);
  ranges.first.push_back(limit);
  return ranges;
}

GlobalIndex lowest_of_all(const parallel::Communicator& communicator, GlobalIndex mine) {
  constexpr GlobalIndex none = std::numeric_limits<GlobalIndex>::max();
  const GlobalIndex lowest = communicator.minimum(static_cast<std::int64_t>(mine < 0 ? none : mine));
  return lowest == none ? -1 : lowest;
}

PointStore::PointStore(const parallel::Communicator& communicator, KeyRanges ranges,
                       std::vector<KeyedPoint> points)
    : _communicator(communicator), _ranges(std::move(ranges)) {
  _points = mesh::deliver(communicator, std::move(points),
                          [&](const KeyedPoint& point) { return _ranges.rank_of(point.key); });
  std::stable_sort(_points.begin(), _points.end(),
                   [](const KeyedPoint& a, const KeyedPoint& b) { return a.key < b.key; });
  std::size_t kept = 0;
  for (const KeyedPoint& point : _points) {
    if (kept > 0 && _points[kept - 1].key == point.key) {
      const bool equal = same_bits(_points[kept - 1].at, point.at);
      if (!equal && _clash < 0) _clash = point.key;
    } else {
      _points[kept++] = point;
    }
  }
  _points.resize(kept);
  _clash = lowest_of_all(communicator, _clash);
  _count = communicator.sum(static_cast<std::int64_t>(kept));
}

std::vector<PointStore::Question> PointStore::ask(const std::vector<GlobalIndex>& keys) const {
  std::vector<Question> questions;
  questions.reserve(keys.size());
  for (const GlobalIndex key : keys) questions.push_back({key, _communicator.rank()});
  return mesh::deliver(_communicator, std::move(questions),
                       [&](const Question& question) { return _ranges.rank_of(question.key); });
}

std::int64_t PointStore::position(GlobalIndex key) const {
  const auto found =
      std::lower_bound(_points.begin(), _points.end(), key,
                       [](const KeyedPoint& point, GlobalIndex wanted) { return point.key < wanted; });
  return found != _points.end() && found->key == key ? found - _points.begin() : -1;
}

// Ranges ascend with ranks, and each rank answers in the order it was asked: answers arrive in the order of
// the keys.
PointStore::Found PointStore::fetch(const std::vector<GlobalIndex>& keys) const {
  struct Answer {
    std::array<double, 3> at;
    std::int64_t rank;
  };
  Found found;
  std::vector<Answer> answers;
  for (const Question& question : ask(keys)) {
    const std::int64_t at = position(question.key);
    if (at < 0 && (found.missing < 0 || question.key < found.missing)) found.missing = question.key;
    if (at >= 0) answers.push_back({_points[at].at, question.rank});
  }
  const auto arrived = mesh::deliver(_communicator, std::move(answers), [](const Answer& answer) {
    return static_cast<parallel::Rank>(answer.rank);
  });
  found.points.reserve(arrived.size());
  for (const Answer& answer : arrived) found.points.push_back(answer.at);
  found.missing = lowest_of_all(_communicator, found.missing);
  return found;
}

/// Numbers by position, to those who asked for them.
std::vector<GlobalIndex> PointStore::answer(const std::vector<Question>& questions,
                                            const std::vector<GlobalIndex>& numbers) const {
  struct Answer {
    GlobalIndex number;
    std::int64_t rank;
  };
  std::vector<Answer> answers;
  answers.reserve(questions.size());
  for (const Question& question : questions) {
    const std::int64_t at = position(question.key);
    answers.push_back({at < 0 ? -1 : numbers[at], question.rank});
  }
  std::vector<GlobalIndex> result;
  for (const Answer& item : mesh::deliver(_communicator, std::move(answers), [](const Answer& answer) {
         return static_cast<parallel::Rank>(answer.rank);
       }))
    result.push_back(item.number);
  return result;
}

PointStore::Numbers PointStore::number(const std::vector<GlobalIndex>& used,
                                       const std::vector<GlobalIndex>& others) {
  const std::vector<Question> questions = ask(used);
  std::vector<GlobalIndex> askers(_points.size(), 0);
  for (const Question& question : questions) {
    if (const std::int64_t at = position(question.key); at >= 0) ++askers[at];
  }
  const auto mine =
      static_cast<GlobalIndex>(_points.size()) - std::count(askers.begin(), askers.end(), GlobalIndex{0});
  const GlobalIndex first = _communicator.exclusive_scan(mine);
  std::vector<GlobalIndex> numbers(_points.size(), -1), marked(_points.size(), -1);
  GlobalIndex next = first;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (askers[i] == 0) continue;
    numbers[i] = next++;
    marked[i] = 2 * numbers[i] + (askers[i] > 1 ? 1 : 0);
  }
  Numbers result{answer(questions, marked), answer(ask(others), numbers), {}};
  result.shared.reserve(result.used.size());
  for (GlobalIndex& number : result.used) {
    result.shared.push_back(number >= 0 ? static_cast<std::uint8_t>(number % 2) : 0);
    if (number >= 0) number /= 2;
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < _points.size(); ++i) {
    if (numbers[i] >= 0) _points[kept++] = {numbers[i], _points[i].at};
  }
  _points.resize(kept);
  const std::vector<GlobalIndex> here{first};
  _ranges.first = _communicator.all_gather_items(std::span<const GlobalIndex>(here));
  _count = _communicator.sum(mine);
  _ranges.first.push_back(_count);
  return result;
}

}  // namespace aeroloom::io
