/// A recorded run's messages without its work, beside what the model of pipeline/study/exchange_model.hpp
/// says that they take: mpirun -n N message_benchmark FOLDER [REPEATS], where FOLDER is what a run has left.
///
/// Two cores cannot tell waiting for a message from waiting for a processor; ranks that have nothing else to
/// do can. Of each kind a stage makes as many calls as the record has, of equal lengths that add up to the
/// recorded bytes; partners are the ranks next to a rank. Latency and bandwidth are measured first, between
/// the same ranks. Prints a line for each stage: the median of the repeats of the slowest rank.
#include "parallel/communication/environment.hpp"
#include "parallel/communication/neighbour_exchange.hpp"
#include "parallel/communication/network_probe.hpp"
#include "parallel/observation/timers.hpp"
#include "pipeline/study/exchange_model.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <vector>

namespace {

using namespace aeroloom;
using parallel::Bytes;
using parallel::Communicator;
using parallel::Messages;
using parallel::Rank;

std::size_t part_of(std::int64_t bytes, std::int64_t parts) {
  return static_cast<std::size_t>(bytes / std::max<std::int64_t>(1, parts));
}

/// The messages of one stage on the ranks of the communicator.
class StageMessages {
public:
  StageMessages(const Communicator& communicator, const study::StageExchanges& exchanges, int recorded)
      : _communicator(communicator), _asked(exchanges.asked) {
    const std::int64_t ranks = communicator.size(), others = ranks - 1;
    _partners = static_cast<std::int64_t>(study::partners_of(exchanges, recorded, communicator.size()));
    // Of what ranks have for each other the part that left its rank in the record.
    const std::int64_t leaving =
        recorded > 1 ? exchanges.sent.rendezvous.bytes : _asked.rendezvous.bytes * others / ranks;
    _parcel = part_of(leaving, _asked.rendezvous.count * ranks * _partners);
    _item = part_of(_asked.neighbour.bytes, _asked.neighbour.count * ranks * _partners);
  }

  /// Takes the memory of what is handed over, which the run packs beforehand.
  void prepare() {
    _parcels.assign(static_cast<std::size_t>(_asked.rendezvous.count), {});
    for (std::vector<parallel::Parcel>& parcels : _parcels) {
      for (std::int64_t i = 0; i < _partners; ++i) parcels.push_back({partner(i), Bytes(_parcel)});
    }
    _gathered = Bytes(part_of(_asked.all_gather.bytes, _asked.all_gather.count * _communicator.size()));
    _sent = Bytes(static_cast<std::size_t>(_partners) * _item);
  }

  void send_all() {
    const Messages reductions = _asked.reduction;
    std::vector<std::int64_t> values(
        std::max<std::size_t>(1, part_of(reductions.bytes, reductions.count) / sizeof(std::int64_t)));
    for (std::int64_t i = 0; i < reductions.count; ++i) _communicator.sum_each(values);
    for (std::int64_t i = 0; i < _asked.broadcast.count; ++i) {
      Bytes content(part_of(_asked.broadcast.bytes, _asked.broadcast.count));
      _communicator.broadcast(content);
    }
    // Sizes are a table of their own in the record, as they are here.
    for (std::int64_t i = 0; i < _asked.all_gather.count; ++i)
      _communicator.all_gather_items(std::span<const std::byte>(_gathered));
    for (std::int64_t i = _asked.all_gather.count; i < _asked.table.count; ++i) _communicator.sum(0.0);
    for (std::int64_t i = 0; i < _asked.gather.count; ++i)
      _communicator.gather(Bytes(part_of(_asked.gather.bytes, _asked.gather.count * _communicator.size())));
    for (std::vector<parallel::Parcel>& parcels : _parcels) _communicator.exchange(std::move(parcels));
    exchange_with_neighbours();
  }

private:
  Rank partner(std::int64_t i) const {
    return static_cast<Rank>((_communicator.rank() + 1 + i) % _communicator.size());
  }
  Rank partner_of(std::int64_t i) const {
    return static_cast<Rank>((_communicator.rank() + 2 * _communicator.size() - 1 - i) %
                             _communicator.size());
  }
  void exchange_with_neighbours() const {
    if (_asked.neighbour.count == 0) return;
    std::vector<parallel::PartnerItems> sends, receives;
    for (std::int64_t i = 0; i < _partners; ++i) {
      sends.push_back({partner(i), _item});
      receives.push_back({partner_of(i), _item});
    }
    const parallel::NeighbourExchange neighbours(_communicator, sends, receives);
    for (std::int64_t i = 0; i < _asked.neighbour.count; ++i) {
      Bytes in(_sent.size());  // each rank has as much for the ranks behind it
      neighbours.exchange(std::span<const std::byte>(_sent), std::span<std::byte>(in));
    }
  }

  const Communicator& _communicator;
  const parallel::ExchangeCounts& _asked;
  std::int64_t _partners = 0;
  std::size_t _parcel = 0, _item = 0;
  std::vector<std::vector<parallel::Parcel>> _parcels;  // of each rendezvous
  Bytes _gathered, _sent;
};

double median_seconds(const Communicator& communicator, StageMessages& messages, int repeats) {
  std::vector<double> seconds;
  for (int i = 0; i < repeats; ++i) {
    messages.prepare();
    communicator.barrier();
    const double start = parallel::wall_seconds();
    messages.send_all();
    communicator.barrier();
    seconds.push_back(communicator.maximum(parallel::wall_seconds() - start));
  }
  std::nth_element(seconds.begin(), seconds.begin() + repeats / 2, seconds.end());
  return seconds[static_cast<std::size_t>(repeats / 2)];
}

void run(const Communicator& communicator, const char* folder, int repeats) {
  const study::RunCosts costs = study::read_costs(folder);
  const parallel::NetworkProbe probe = parallel::probe_network(communicator);
  const study::Network network{probe.latency_seconds, probe.bytes_per_second};
  if (communicator.is_root())
    std::printf(
        "%d ranks, record of %d; latency %.3g s, bandwidth %.3g bytes/s\n\n"
        "| stage | predicted, s | measured, s | ratio |\n|---|---|---|---|\n",
        communicator.size(), costs.ranks, network.latency, network.bandwidth);
  double predicted = 0, measured = 0;
  const auto print = [&](const char* name, double model, double seconds) {
    if (communicator.is_root())
      std::printf("| %s | %.4f | %.4f | %.2f |\n", name, model, seconds, model / seconds);
  };
  for (const study::StageCosts& stage : costs.stages) {
    const double model = study::exchange_seconds(stage.exchanges, costs.ranks, communicator.size(), network);
    if (model <= 0) continue;
    StageMessages messages(communicator, stage.exchanges, costs.ranks);
    const double seconds = median_seconds(communicator, messages, repeats);
    print(stage.name.c_str(), model, seconds);
    predicted += model;
    measured += seconds;
  }
  print("all", predicted, measured);
}

}  // namespace

int main(int argc, char** argv) {
  const parallel::Environment environment(argc, argv);
  const Communicator world = Communicator::world();
  if (argc < 2 || world.size() < 2) {
    if (world.is_root())
      std::fprintf(stderr, "usage: mpirun -n 2 (or more) message_benchmark FOLDER [REPEATS]\n");
    return 2;
  }
  try {
    run(world, argv[1], argc > 2 ? std::max(1, std::atoi(argv[2])) : 5);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "message_benchmark: %s\n", error.what());
    return 1;
  }
}
