/// Values by key, spread over the ranks by ranges of keys.
#pragma once

#include "mesh/data/piece.hpp"
#include "mesh/exchange/delivery.hpp"
#include "parallel/communication/communicator.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace aeroloom::mesh {

/// Which rank keeps which keys: rank r those from first[r] to first[r + 1] - 1.
struct KeyRanges {
  std::vector<GlobalIndex> first;  ///< (size + 1)
  parallel::Rank rank_of(GlobalIndex key) const;
};
/// Ranges of equal width below `limit`.
KeyRanges even_ranges(int ranks, GlobalIndex limit);
/// Ranges below `limit` that share out the keys of all ranks: even ones where keys are dense, otherwise such
/// that a few keys far from the others change nothing (splitters of samples: Shi, Schaeffer, J. Parallel
/// Distrib. Comput. 14, 1992, doi:10.1016/0743-7315(92)90075-X). Collective.
KeyRanges fair_ranges(const parallel::Communicator& communicator, std::vector<GlobalIndex> keys,
                      GlobalIndex limit);

/// The lowest of what the ranks say, -1 standing for nothing. Collective.
GlobalIndex lowest_of_all(const parallel::Communicator& communicator, GlobalIndex mine);

/// Keys are ids of a file, or numbers. The bits of values are compared.
template <parallel::Flat Value>
class DistributedTable {
public:
  struct KeyedValue {
    GlobalIndex key = 0;
    Value value{};
  };

  /// Takes rows of any rank to those of their keys. A key may come several times; the first in the order of
  /// ranks stays, and `clash` becomes the lowest key whose values differ in a bit (-1: none). Collective.
  DistributedTable(const parallel::Communicator& communicator, KeyRanges ranges,
                   std::vector<KeyedValue> rows);

  /// The values of ascending keys, each once; `missing` is the lowest key, asked for anywhere, that there is
  /// not (-1: none): the values are then worth nothing. Collective.
  struct Fetched {
    std::vector<Value> values;
    GlobalIndex missing = -1;
  };
  Fetched fetch(const std::vector<GlobalIndex>& keys) const;

  /// Numbers the rows that anyone names among `used`, in the order of their keys, and drops the others;
  /// their numbers become their keys. Returns the numbers of `used` and of `others` (both as in fetch; -1
  /// where there is no such row any more), and which of `used` other ranks named too. Collective.
  struct Numbers {
    std::vector<GlobalIndex> used, others;
    std::vector<std::uint8_t> shared;
  };
  Numbers number(const std::vector<GlobalIndex>& used, const std::vector<GlobalIndex>& others);

  GlobalIndex clash() const { return _clash; }
  GlobalIndex count() const { return _count; }                   ///< of all ranks
  const std::vector<KeyedValue>& mine() const { return _rows; }  ///< ascending key

private:
  struct Question {
    GlobalIndex key;
    parallel::Rank rank;
  };
  template <class What>
  struct Answer {
    What what;
    parallel::Rank rank;
  };

  std::vector<Question> ask(const std::vector<GlobalIndex>& keys) const;
  std::int64_t position(GlobalIndex key) const;
  /// Ranges ascend with ranks, and each rank answers in the order it was asked: answers arrive in the order
  /// of the keys.
  template <class What>
  std::vector<What> reply(std::vector<Answer<What>> answers) const;
  std::vector<GlobalIndex> answer(const std::vector<Question>& questions,
                                  const std::vector<GlobalIndex>& numbers) const;

  parallel::Communicator _communicator;
  KeyRanges _ranges;
  std::vector<KeyedValue> _rows;
  GlobalIndex _clash = -1, _count = 0;
};

template <parallel::Flat Value>
DistributedTable<Value>::DistributedTable(const parallel::Communicator& communicator, KeyRanges ranges,
                                          std::vector<KeyedValue> rows)
    : _communicator(communicator), _ranges(std::move(ranges)) {
  _rows =
      deliver(communicator, std::move(rows), [&](const KeyedValue& row) { return _ranges.rank_of(row.key); });
  std::stable_sort(_rows.begin(), _rows.end(),
                   [](const KeyedValue& a, const KeyedValue& b) { return a.key < b.key; });
  std::size_t kept = 0;
  for (const KeyedValue& row : _rows) {
    if (kept > 0 && _rows[kept - 1].key == row.key) {
      const bool equal = parallel::same_bits(_rows[kept - 1].value, row.value);
      if (!equal && _clash < 0) _clash = row.key;
    } else {
      _rows[kept++] = row;
    }
  }
  _rows.resize(kept);
  _clash = lowest_of_all(communicator, _clash);
  _count = communicator.sum(static_cast<std::int64_t>(kept));
}

template <parallel::Flat Value>
std::vector<typename DistributedTable<Value>::Question> DistributedTable<Value>::ask(
    const std::vector<GlobalIndex>& keys) const {
  std::vector<Question> questions;
  questions.reserve(keys.size());
  for (const GlobalIndex key : keys) questions.push_back({key, _communicator.rank()});
  return deliver(_communicator, std::move(questions),
                 [&](const Question& question) { return _ranges.rank_of(question.key); });
}

template <parallel::Flat Value>
std::int64_t DistributedTable<Value>::position(GlobalIndex key) const {
  const auto found =
      std::lower_bound(_rows.begin(), _rows.end(), key,
                       [](const KeyedValue& row, GlobalIndex wanted) { return row.key < wanted; });
  return found != _rows.end() && found->key == key ? found - _rows.begin() : -1;
}

template <parallel::Flat Value>
template <class What>
std::vector<What> DistributedTable<Value>::reply(std::vector<Answer<What>> answers) const {
  answers = deliver(_communicator, std::move(answers), [](const Answer<What>& a) { return a.rank; });
  std::vector<What> result;
  result.reserve(answers.size());
  for (const Answer<What>& each : answers) result.push_back(each.what);
  return result;
}

template <parallel::Flat Value>
typename DistributedTable<Value>::Fetched DistributedTable<Value>::fetch(
    const std::vector<GlobalIndex>& keys) const {
  Fetched found;
  std::vector<Answer<Value>> answers;
  for (const Question& question : ask(keys)) {
    const std::int64_t at = position(question.key);
    if (at < 0 && (found.missing < 0 || question.key < found.missing)) found.missing = question.key;
    if (at >= 0) answers.push_back({_rows[at].value, question.rank});
  }
  found.values = reply(std::move(answers));
  found.missing = lowest_of_all(_communicator, found.missing);
  return found;
}

/// Numbers by position, to those who asked for them.
template <parallel::Flat Value>
std::vector<GlobalIndex> DistributedTable<Value>::answer(const std::vector<Question>& questions,
                                                         const std::vector<GlobalIndex>& numbers) const {
  std::vector<Answer<GlobalIndex>> answers;
  answers.reserve(questions.size());
  for (const Question& question : questions) {
    const std::int64_t at = position(question.key);
    answers.push_back({at < 0 ? -1 : numbers[at], question.rank});
  }
  return reply(std::move(answers));
}

template <parallel::Flat Value>
typename DistributedTable<Value>::Numbers DistributedTable<Value>::number(
    const std::vector<GlobalIndex>& used, const std::vector<GlobalIndex>& others) {
  const std::vector<Question> questions = ask(used);
  std::vector<GlobalIndex> askers(_rows.size(), 0);
  for (const Question& question : questions) {
    if (const std::int64_t at = position(question.key); at >= 0) ++askers[at];
  }
  const auto mine =
      static_cast<GlobalIndex>(_rows.size()) - std::count(askers.begin(), askers.end(), GlobalIndex{0});
  const GlobalIndex first = _communicator.exclusive_scan(mine);
  std::vector<GlobalIndex> numbers(_rows.size(), -1), marked(_rows.size(), -1);
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
  for (std::size_t i = 0; i < _rows.size(); ++i) {
    if (numbers[i] >= 0) _rows[kept++] = {numbers[i], _rows[i].value};
  }
  _rows.resize(kept);
  const std::vector<GlobalIndex> here{first};
  _ranges.first = _communicator.all_gather_items(std::span<const GlobalIndex>(here));
  _count = _communicator.sum(mine);
  _ranges.first.push_back(_count);
  return result;
}

}  // namespace aeroloom::mesh
