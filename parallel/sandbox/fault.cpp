#include "parallel/sandbox/fault.hpp"

#include <atomic>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace aeroloom::parallel {

void inject_fault(Fault fault) {
  if (fault == Fault::throws) throw std::runtime_error("injected fault: an exception");
  if (fault == Fault::aborts) std::abort();
  if (fault == Fault::hangs) {
    for (;;) std::atomic_signal_fence(std::memory_order_seq_cst);
  }
  if (fault == Fault::exhausts_memory) {
    // The limit is on the address space: nearly none of it need be written.
    constexpr std::size_t chunk = 64 << 20;
    std::vector<std::vector<char>> hoard;
    for (;;) {
      hoard.emplace_back().reserve(chunk);
      hoard.back().push_back('x');
    }
  }
}

FaultRequest requested_fault(std::string_view task) {
  const char* variable = std::getenv("AEROLOOM_FAULT");
  if (variable == nullptr) return {};
  const std::string_view request = variable;
  const std::size_t equals = request.find('='), at = request.find('@');
  static const std::map<std::string_view, Fault> faults{{"throws", Fault::throws},
                                                        {"aborts", Fault::aborts},
                                                        {"hangs", Fault::hangs},
                                                        {"exhausts_memory", Fault::exhausts_memory}};
  const auto named =
      equals == request.npos ? faults.end() : faults.find(request.substr(equals + 1, at - equals - 1));
  const std::string number(at == request.npos ? "-1" : request.substr(at + 1));
  const bool is_number = !number.empty() && number.find_first_not_of("0123456789") == number.npos;
  if (named == faults.end() || (at != request.npos && !is_number))
    throw std::invalid_argument("AEROLOOM_FAULT is '" + std::string(request) +
                                "'; it must be TASK=FAULT or TASK=FAULT@NUMBER");
  if (request.substr(0, equals) != task) return {};
  return {named->second, std::stoll(number)};
}

}  // namespace aeroloom::parallel
