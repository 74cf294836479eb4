/// Arrays that are the same on every rank, held once per node.
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

/// Memory that the ranks of a node read together. Internal to this header.
class NodeMemory {
public:
  /// The bytes, which are the same on every rank, in memory of the node; nothing where each rank has to keep
  /// its own, because it is alone on its node or the system refuses. Kept until the last copy of the result
  /// is gone on the last rank, which may let it go whenever it likes. Collective.
  static std::shared_ptr<const std::byte> share(const Communicator& communicator,
                                                std::span<const std::byte> bytes);
  /// The bytes of all ranks one after another, which come to each node once; nothing where the memory cannot
  /// be had on some node. Collective.
  static std::shared_ptr<const std::byte> gather(const Communicator& communicator,
                                                 std::span<const std::byte> mine);

  /// The bytes of all ranks one after another, those of ranks of other nodes still to be written.
  struct Composition {
    std::shared_ptr<std::byte> memory;  ///< of the node where that can be had, else of this rank alone
    bool is_of_node = false;
    std::vector<std::uint64_t> offsets;  ///< per rank where its bytes begin, and the end
    std::vector<Rank> unwritten;         ///< ranks whose bytes this rank has to write

    std::span<std::byte> part(Rank rank) const {
      const auto r = static_cast<std::size_t>(rank);
      return {memory.get() + offsets[r], offsets[r + 1] - offsets[r]};
    }
  };
  /// Ranks of a node share what is unwritten among them. Collective.
  static Composition compose(const Communicator& communicator, std::span<const std::byte> mine);
  /// The memory, to be read only. After all ranks have written their parts.
  static std::shared_ptr<const std::byte> finish(Composition composition);
};

/// An array that does not change. Cheap to copy: copies refer to the same memory.
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
  /// Memory of the node where that can be had. Every rank gives the same items. Collective.
  NodeArray(const Communicator& communicator, std::vector<T> items) {
    *this = NodeArray(std::move(items)).shared(communicator);
  }
  /// The items in memory of the node, where that can be had. They are the same on every rank.
  /// Collective.
  NodeArray shared(const Communicator& communicator) const {
    NodeArray result;
    result._owner = NodeMemory::share(communicator, std::as_bytes(_items));
    if (!result._owner) return *this;
    result._items = {static_cast<const T*>(result._owner.get()), _items.size()};
    return result;
  }

  /// Concatenation of every rank's items in rank order, in memory of the node where that can be had.
  /// Collective.
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

  /// As gathered(), of items that follow from what every node knows already: parts of other nodes do not
  /// travel, but are written here. `write(rank, first, items)` writes the part of a rank, whose first item is
  /// number `first` of all; which ranks it is called for depends on the nodes. What it throws all ranks
  /// throw, as a CollectiveError. Collective.
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

/// Read into memory of this rank alone.
template <class T>
struct Wire<NodeArray<T>> {
  static constexpr std::size_t least = least_wire_size<std::vector<T>>;
  static void pack(Packer& packer, const NodeArray<T>& array) { packer.array(array.items()); }
  static void unpack(Unpacker& unpacker, NodeArray<T>& array) { array = NodeArray<T>(unpacker.array<T>()); }
};

}  // namespace aeroloom::parallel
