/// Rendezvous by key: what several ranks know of one thing comes together on one of them.
#pragma once

#include "geometry/runs.hpp"
#include "mesh/data/mixing.hpp"
#include "mesh/exchange/delivery.hpp"
#include "parallel/communication/communicator.hpp"

#include <algorithm>
#include <array>
#include <compare>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace aeroloom::mesh {

/// A key is a whole number, or an array of keys: numbers of vertices, shared-vertex keys, bits of
/// coordinates.
template <std::integral Word>
constexpr std::uint64_t mix_key(std::uint64_t state, Word key) {
  return mix_in(state, static_cast<std::uint64_t>(key));
}
template <class Key, std::size_t N>
constexpr std::uint64_t mix_key(std::uint64_t state, const std::array<Key, N>& keys) {
  for (const Key& key : keys) state = mix_key(state, key);
  return state;
}

/// Brings items with equal keys together on the rank that the mixed key points to. `key_of(item)` is a key as
/// above, `place_of(item)` tells items of one key apart: anything that can be compared and does not depend on
/// ranks. Both may be pointers to members. Returns what meets here, ascending by key, then place. Collective.
template <class Item, class KeyOf, class PlaceOf>
std::vector<Item> meet_by_key(const parallel::Communicator& communicator, std::vector<Item> items,
                              const KeyOf& key_of, const PlaceOf& place_of) {
  std::vector<Item> met = deliver(communicator, std::move(items), [&](const Item& item) {
    return meeting_rank(mix_key(0, std::invoke(key_of, item)), communicator.size());
  });
  std::sort(met.begin(), met.end(), [&](const Item& a, const Item& b) {
    const auto order = std::invoke(key_of, a) <=> std::invoke(key_of, b);
    return order != 0 ? order < 0 : std::invoke(place_of, a) < std::invoke(place_of, b);
  });
  return met;
}

/// Calls visit(group) for the items of each key in turn: a span of a list sorted by key.
template <class Item, class KeyOf, class Visit>
void for_each_key(const std::vector<Item>& items, const KeyOf& key_of, const Visit& visit) {
  const std::span<const Item> all(items);
  geometry::for_each_run(
      all, [&](const Item& a, const Item& b) { return std::invoke(key_of, a) == std::invoke(key_of, b); },
      [&](std::size_t first, std::size_t last) { visit(all.subspan(first, last - first)); });
}

/// An item at a rendezvous, and the rank it came from.
template <class Item>
struct Guest {
  Item item;
  parallel::Rank from;
};

/// A rendezvous whose guests are told something. Items meet as in meet_by_key; `from` must not be judged by:
/// it depends on ranks.
template <class Item, class KeyOf, class PlaceOf>
class Rendezvous {
public:
  /// Collective.
  Rendezvous(const parallel::Communicator& communicator, const std::vector<Item>& items, KeyOf key_of,
             const PlaceOf& place_of)
      : _communicator(communicator), _key_of(std::move(key_of)) {
    std::vector<Guest<Item>> guests;
    guests.reserve(items.size());
    for (const Item& item : items) guests.push_back({item, communicator.rank()});
    _met = meet_by_key(communicator, std::move(guests), key_of_guest(),
                       [&](const Guest<Item>& guest) { return std::invoke(place_of, guest.item); });
  }

  /// What meets here, by key and place.
  const std::vector<Guest<Item>>& met() const { return _met; }

  /// Calls visit(group) for each key: a span of guests.
  template <class Visit>
  void for_each_group(const Visit& visit) const {
    for_each_key(_met, key_of_guest(), visit);
  }

  /// Calls judge(group, reply) for each key; reply(guest, answer) sends an Answer to where the guest came
  /// from, as often as it is called. Returns the answers that arrive here, in no order that matters.
  /// Collective.
  template <class Answer, class Judge>
  std::vector<Answer> answer(const Judge& judge) const {
    std::vector<Guest<Answer>> replies;
    const auto reply = [&](const Guest<Item>& guest, const Answer& what) {
      replies.push_back({what, guest.from});
    };
    for_each_group([&](std::span<const Guest<Item>> group) { judge(group, reply); });
    replies =
        deliver(_communicator, std::move(replies), [](const Guest<Answer>& guest) { return guest.from; });
    std::vector<Answer> answers;
    answers.reserve(replies.size());
    for (const Guest<Answer>& guest : replies) answers.push_back(guest.item);
    return answers;
  }

private:
  auto key_of_guest() const {
    return [this](const Guest<Item>& guest) -> decltype(auto) { return std::invoke(_key_of, guest.item); };
  }

  const parallel::Communicator& _communicator;
  KeyOf _key_of;
  std::vector<Guest<Item>> _met;
};

}  // namespace aeroloom::mesh
