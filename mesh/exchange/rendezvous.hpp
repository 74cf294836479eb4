/// Rendezvous by key: items with equal keys, from any rank, are sent to one rank, which can answer them.
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

/// Mixes a key into a hash. A key is an integer or an array of keys, such as vertex numbers, shared-vertex
/// keys or bits of coordinates.
template <std::integral Word>
constexpr std::uint64_t mix_key(std::uint64_t state, Word key) {
  return mix_in(state, static_cast<std::uint64_t>(key));
}
template <class Key, std::size_t N>
constexpr std::uint64_t mix_key(std::uint64_t state, const std::array<Key, N>& keys) {
  for (const Key& key : keys) state = mix_key(state, key);
  return state;
}

/// Sends items to the rank that the hash of their key names, so that items with equal keys meet.
/// `key_of(item)` is a key as above. `place_of(item)` orders items of one key; it must not depend on ranks.
/// Both may be pointers to members. Returns the items received, ascending by key, then place. Collective.
template <class Item, class KeyOf, class PlaceOf>
std::vector<Item> meet_by_key(const parallel::Communicator& communicator, std::vector<Item> items,
                              const KeyOf& key_of, const PlaceOf& place_of) {
  std::vector<Item> received = deliver(communicator, std::move(items), [&](const Item& item) {
    return meeting_rank(mix_key(0, std::invoke(key_of, item)), communicator.size());
  });
  std::sort(received.begin(), received.end(), [&](const Item& a, const Item& b) {
    const auto order = std::invoke(key_of, a) <=> std::invoke(key_of, b);
    return order != 0 ? order < 0 : std::invoke(place_of, a) < std::invoke(place_of, b);
  });
  return received;
}

/// Calls visit(group) for each key; `group` is the span of its items. `items` are sorted by key.
template <class Item, class KeyOf, class Visit>
void for_each_key(const std::vector<Item>& items, const KeyOf& key_of, const Visit& visit) {
  const std::span<const Item> all(items);
  geometry::for_each_run(
      all, [&](const Item& a, const Item& b) { return std::invoke(key_of, a) == std::invoke(key_of, b); },
      [&](std::size_t first, std::size_t last) { visit(all.subspan(first, last - first)); });
}

/// An item received at a rendezvous, and the rank that sent it.
template <class Item>
struct Received {
  Item item;
  parallel::Rank from;
};

/// A rendezvous that answers the senders. Items meet as in meet_by_key(). Answers must not depend on `from`,
/// since it depends on the number of ranks.
template <class Item, class KeyOf, class PlaceOf>
class Rendezvous {
public:
  /// Collective.
  Rendezvous(const parallel::Communicator& communicator, const std::vector<Item>& items, KeyOf key_of,
             const PlaceOf& place_of)
      : _communicator(communicator), _key_of(std::move(key_of)) {
    std::vector<Received<Item>> sent;
    sent.reserve(items.size());
    for (const Item& item : items) sent.push_back({item, communicator.rank()});
    _received =
        meet_by_key(communicator, std::move(sent), key_of_received(),
                    [&](const Received<Item>& received) { return std::invoke(place_of, received.item); });
  }

  /// The items received, by key and place.
  const std::vector<Received<Item>>& received() const { return _received; }

  /// Calls visit(group) for each key; `group` is the span of its received items.
  template <class Visit>
  void for_each_group(const Visit& visit) const {
    for_each_key(_received, key_of_received(), visit);
  }

  /// Calls visit(group, reply) for each key. Each call of reply(received, answer) sends an Answer to the
  /// sender of the item. Returns the answers to this rank, in an order that depends on ranks. Collective.
  template <class Answer, class Visit>
  std::vector<Answer> answer(const Visit& visit) const {
    std::vector<Received<Answer>> replies;
    const auto reply = [&](const Received<Item>& received, const Answer& what) {
      replies.push_back({what, received.from});
    };
    for_each_group([&](std::span<const Received<Item>> group) { visit(group, reply); });
    replies = deliver(_communicator, std::move(replies),
                      [](const Received<Answer>& received) { return received.from; });
    std::vector<Answer> answers;
    answers.reserve(replies.size());
    for (const Received<Answer>& received : replies) answers.push_back(received.item);
    return answers;
  }

private:
  auto key_of_received() const {
    return [this](const Received<Item>& received) -> decltype(auto) {
      return std::invoke(_key_of, received.item);
    };
  }

  const parallel::Communicator& _communicator;
  KeyOf _key_of;
  std::vector<Received<Item>> _received;
};

}  // namespace aeroloom::mesh
