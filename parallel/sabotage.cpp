#include "parallel/sabotage.hpp"

#include <atomic>
#include <cstdlib>
#include <stdexcept>
#include <vector>

namespace aeroloom::parallel {

void commit_sabotage(Sabotage sabotage) {
  if (sabotage == Sabotage::throws) throw std::runtime_error("sabotage: an exception");
  if (sabotage == Sabotage::aborts) std::abort();
  if (sabotage == Sabotage::hangs) {
    for (;;) std::atomic_signal_fence(std::memory_order_seq_cst);
  }
  if (sabotage == Sabotage::exhausts_memory) {
    // What is limited is the address space: nearly none of it need be written.
    constexpr std::size_t chunk = 64 << 20;
    std::vector<std::vector<char>> hoard;
    for (;;) {
      hoard.emplace_back().reserve(chunk);
      hoard.back().push_back('x');
    }
  }
}

}  // namespace aeroloom::parallel
