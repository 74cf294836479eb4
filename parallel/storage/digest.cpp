#include "parallel/storage/digest.hpp"

#include <new>

#include <fmt/format.h>
#include <xxhash.h>

namespace aeroloom::parallel {

struct Digester::State {
  XXH3_state_t* hash = XXH3_createState();

  State() {
    if (hash == nullptr) throw std::bad_alloc();
    XXH3_128bits_reset(hash);
  }
  ~State() { XXH3_freeState(hash); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
};

std::string Digest::text() const {
  return fmt::format("{:016x}{:016x}", high, low);
}

Digester::Digester() : _state(std::make_unique<State>()) {}
Digester::~Digester() = default;

Digester& Digester::bytes(std::span<const std::byte> bytes) {
  if (!bytes.empty()) XXH3_128bits_update(_state->hash, bytes.data(), bytes.size());
  return *this;
}

Digester& Digester::text(std::string_view text) {
  return items(std::span<const char>(text));
}

Digest Digester::result() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(_state->hash);
  return {hash.low64, hash.high64};
}

Digest digest_of(std::span<const std::byte> bytes) {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return {hash.low64, hash.high64};
}

}  // namespace aeroloom::parallel
