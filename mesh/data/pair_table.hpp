/// A small hash table that finds what meets in pairs.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace aeroloom::mesh {

/// Items with a key, of which mostly one or two are equal. Emptied in constant time; the answers do not
/// depend on the order of the slots.
class PairTable {
public:
  /// How many items with its key there are now, and the one that came first.
  struct Outcome {
    std::uint32_t count, first;
  };

  /// Empties the table for that many items.
  void begin(std::size_t items) {
    _open = 0;
    if (_slots.size() < 2 * items) {
      _slots.assign(std::bit_ceil(2 * items), {});
      _shift = 64 - std::countr_zero(_slots.size());
      _round = 0;
    }
    if (++_round == 0) {  // of all rounds that a slot may remember
      _slots.assign(_slots.size(), {});
      _round = 1;
    }
  }

  Outcome add(std::uint64_t key, std::uint32_t item) {
    std::size_t at = key * 0x9e3779b97f4a7c15ULL >> _shift;
    while (_slots[at].round == _round && _slots[at].key != key) at = (at + 1) & (_slots.size() - 1);
    Slot& slot = _slots[at];
    if (slot.round != _round) slot = {key, item, 0, _round};
    ++slot.count;
    if (slot.count == 1) ++_open;
    if (slot.count == 2) --_open;
    return {slot.count, slot.item};
  }

  /// Whether holds(item) for all items that are alone with their key.
  template <class Holds>
  bool all_single(const Holds& holds) const {
    if (_open == 0) return true;
    for (const Slot& slot : _slots) {
      if (slot.round == _round && slot.count == 1 && !holds(slot.item)) return false;
    }
    return true;
  }

private:
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t item = 0, count = 0, round = 0;
  };

  std::vector<Slot> _slots = std::vector<Slot>(64);
  int _shift = 58;
  std::uint32_t _round = 0;
  std::size_t _open = 0;  ///< keys of one item
};

}  // namespace aeroloom::mesh
