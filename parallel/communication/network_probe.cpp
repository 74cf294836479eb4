#include "parallel/communication/network_probe.hpp"

#include "parallel/communication/host.hpp"
#include "parallel/communication/session.hpp"
#include "parallel/observation/timers.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <stdexcept>

namespace aeroloom::parallel {

namespace {

using session::check;

constexpr std::array<int, 8> lengths{8, 64, 1 << 10, 1 << 13, 1 << 16, 1 << 18, 1 << 20, 1 << 22};
/// Of each length, the fastest of which counts: others met something else on the network or the core.
constexpr int repeats = 31;
constexpr int kept_bytes = 32 << 20;  // a rank keeps no more of what arrives
constexpr double clock_step = 1e-9;   // seconds

/// The time of the network alone: the fastest of several had no other work on its processors meanwhile.
double least(const std::vector<double>& values) {
  return *std::min_element(values.begin(), values.end());
}

/// To the partner and from it at a time, as ranks exchange: both directions share what a rank can copy. What
/// arrives is received into memory that is taken for it, as exchanges do: pages that the system has to clear.
double exchange_once(MPI_Comm group, int partner, const Bytes& content, Bytes& arrived) {
  const double begin = wall_seconds();
  const auto length = static_cast<int>(content.size());
  arrived = Bytes(content.size());
  check(MPI_Sendrecv(content.data(), length, MPI_BYTE, partner, 0, arrived.data(), length, MPI_BYTE, partner,
                     0, group, MPI_STATUS_IGNORE),
        "exchanging");
  return wall_seconds() - begin;
}

double time_messages(const Communicator& communicator, MPI_Comm group, int length) {
  const int half = communicator.size() / 2, rank = communicator.rank();
  const bool takes_part = rank < 2 * half;
  const Bytes content(static_cast<std::size_t>(length));
  std::vector<Bytes> arrived(static_cast<std::size_t>(std::min(repeats, kept_bytes / length)));
  std::vector<double> seconds;
  communicator.barrier();
  for (std::size_t i = 0; takes_part && i < arrived.size(); ++i)
    seconds.push_back(exchange_once(group, rank < half ? rank + half : rank - half, content, arrived[i]));
  return communicator.maximum(takes_part ? least(seconds) : 0.0);
}

double time_reductions(const Communicator& communicator) {
  std::vector<double> seconds;
  for (int i = 0; i < repeats; ++i) {
    const double begin = wall_seconds();
    communicator.maximum(std::int64_t{i});
    seconds.push_back(wall_seconds() - begin);
  }
  return communicator.maximum(least(seconds));
}

}  // namespace

NetworkProbe probe_network(const Communicator& communicator) {
  if (communicator.size() < 2)
    throw std::invalid_argument(
        "a network is measured between ranks, and there is one. Remedy: mpirun -n 2 or more");
  MPI_Comm group = host_communicator(communicator);
  NetworkProbe probe;
  time_messages(communicator, group, lengths.front());  // connections are made by the first message
  for (const int length : lengths)
    probe.messages.push_back({length, time_messages(communicator, group, length)});
  probe.reduction_seconds = time_reductions(communicator);
  const int steps = std::bit_width(static_cast<unsigned>(communicator.size() - 1));
  const MessageTiming &shortest = probe.messages.front(), &longest = probe.messages.back();
  probe.latency_seconds = std::max(shortest.seconds, probe.reduction_seconds / steps);
  probe.bytes_per_second =
      static_cast<double>(longest.bytes) / std::max(longest.seconds - shortest.seconds, clock_step);
  return probe;
}

}  // namespace aeroloom::parallel
