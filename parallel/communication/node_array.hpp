/// Constant arrays that are the same on every rank and held once per node, in shared memory.
#pragma once

#include "parallel/communication/collective_error.hpp"
#include "parallel/communication/communicator.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace aeroloom::parallel {

/// Memory shared by the ranks of a node. Internal to this header.
class NodeMemory {
public:
  /// Copies the bytes, which are the same on every rank, into memory of the node. Returns nothing if the
  /// rank is alone on its node or the system refuses; then each rank keeps its own. The memory lives until
  /// the last copy of the result on the last rank is destroyed, at any time. Collective.
  static std::shared_ptr<const std::byte> share(const Communicator& communicator,
                                                std::span<const std::byte> bytes);
  /// Gathers the bytes of all ranks, in rank order, once per node. Returns nothing if a node cannot provide
  /// the memory. Collective.
  static std::shared_ptr<const std::byte> gather(const Communicator& communicator,
                                                 std::span<const std::byte> mine);

  /// Room for the bytes of all ranks. Those of ranks on other nodes are still to be written.
  struct Composition {
    std::shared_ptr<std::byte> memory;  ///< of the node if possible, else of this rank alone
    bool is_of_node = false;
    std::vector<std::uint64_t> offsets;  ///< where the bytes of each rank begin, and the end
    std::vector<Rank> unwritten;         ///< ranks whose bytes this rank has to write

    std::span<std::byte> part(Rank rank) const {
      const auto r = static_cast<std::size_t>(rank);
      return {memory.get() + offsets[r], offsets[r + 1] - offsets[r]};
    }
  };
  /// Assigns the unwritten parts to the ranks of the node. Collective.
  static Composition compose(const Communicator& communicator, std::span<const std::byte> mine);
  /// The memory, read-only. To be called when all ranks have written their parts.
  static std::shared_ptr<const std::byte> finish(Composition composition);
};

/// A constant array. Cheap to copy: copies refer to the same memory.
template <Flat T>
class NodeArray {
public:
  NodeArray() = default;
  /// Memory of this rank alone.
  explicit NodeArray(std::vector<T> items) {
    auto own = std::make_shared<const std::vector<T>>(std::move(items));
    _items = *own;
    _owner = std::move(own);
  }
  /// In memory of the node if possible. Every rank passes the same items. Collective.
  NodeArray(const Communicator& communicator, std::vector<T> items) {
    *this = NodeArray(std::move(items)).shared(communicator);
  }
  /// A copy in memory of the node if possible. The items are the same on every rank. Collective.
  NodeArray shared(const Communicator& communicator) const {
    NodeArray result;
    result._owner = NodeMemory::share(communicator, std::as_bytes(_items));
    if (!result._owner) return *this;
    result._items = {static_cast<const T*>(result._owner.get()), _items.size()};
    return result;
  }

  /// The items of all ranks in rank order, in memory of the node if possible. Collective.
  static NodeArray gathered(const Communicator& communicator, std::vector<T> mine) {
    static_assert(is_exact<T>, "items lie in memory as they travel");
    const std::int64_t count = communicator.sum(static_cast<std::int64_t>(mine.size()));
    NodeArray result;
    result._owner = NodeMemory::gather(communicator, std::as_bytes(std::span<const T>(mine)));
    if (!result._owner && communicator.size() == 1) return NodeArray(std::move(mine));
    if (!result._owner) return NodeArray(communicator.template all_gather_items<T>(mine));
    result._items = {static_cast<const T*>(result._owner.get()), static_cast<std::size_t>(count)};
    return result;
  }

  /// As gathered(), for items that each node can compute: parts of other nodes are computed here instead of
  /// sent. `write(rank, first, items)` computes the part of a rank; `first` is the index of its first item in
  /// the whole array. For which ranks it is called depends on the nodes. If it throws, all ranks throw
  /// CollectiveError. Collective.
  template <class Write>
  static NodeArray composed(const Communicator& communicator, std::vector<T> mine, const Write& write) {
    static_assert(is_exact<T>, "items lie in memory as they travel");
    if (communicator.size() == 1) return NodeArray(std::move(mine));
    NodeMemory::Composition parts =
        NodeMemory::compose(communicator, std::as_bytes(std::span<const T>(mine)));
    agree(communicator, [&] {
      for (const Rank rank : parts.unwritten) {
        const std::span<std::byte> bytes = parts.part(rank);
        write(rank, (bytes.data() - parts.memory.get()) / sizeof(T),
              std::span<T>(reinterpret_cast<T*>(bytes.data()), bytes.size() / sizeof(T)));
      }
    });
    NodeArray result;
    const std::size_t count = parts.offsets.back() / sizeof(T);
    result._owner = NodeMemory::finish(std::move(parts));
    result._items = {static_cast<const T*>(result._owner.get()), count};
    return result;
  }

  const T& operator[](std::size_t i) const { return _items[i]; }
  const T* data() const { return _items.data(); }
  std::size_t size() const { return _items.size(); }
  std::span<const T> items() const { return _items; }

private:
  std::shared_ptr<const void> _owner;
  std::span<const T> _items;
};

/// Travels as a vector. Received arrays lie in memory of this rank alone.
template <class T>
struct Wire<NodeArray<T>> {
  static constexpr std::size_t least = least_wire_size<std::vector<T>>;
  static void pack(Packer& packer, const NodeArray<T>& array) { packer.array(array.items()); }
  static void unpack(Unpacker& unpacker, NodeArray<T>& array) { array = NodeArray<T>(unpacker.array<T>()); }
};

}  // namespace aeroloom::parallel
