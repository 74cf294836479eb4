#include "parallel/communication/neighbour_exchange.hpp"

#include "parallel/communication/host.hpp"
#include "parallel/communication/message_counting.hpp"
#include "parallel/communication/session.hpp"
#include "parallel/communication/transfers.hpp"

#include <stdexcept>
#include <string>
#include <utility>

namespace aeroloom::parallel {
namespace {

std::size_t count_items(const std::vector<PartnerItems>& partners, Rank self, int ranks) {
  std::size_t total = 0;
  std::vector<char> seen(static_cast<std::size_t>(ranks), 0);
  for (const PartnerItems& partner : partners) {
    if (partner.rank < 0 || partner.rank >= ranks || partner.rank == self ||
        std::exchange(seen[static_cast<std::size_t>(partner.rank)], 1)) {
      throw std::logic_error("neighbour exchange: rank " + std::to_string(partner.rank) +
                             " is no partner of rank " + std::to_string(self) + ", or is so twice");
    }
    total += partner.items;
  }
  return total;
}

std::size_t size_of_item(std::size_t bytes, std::size_t items) {
  if (items == 0 ? bytes != 0 : bytes % items != 0)
    throw std::logic_error("neighbour exchange: " + std::to_string(bytes) + " bytes are not " +
                           std::to_string(items) + " items");
  return items == 0 ? 0 : bytes / items;
}

}  // namespace

NeighbourExchange::NeighbourExchange(const Communicator& communicator, std::vector<PartnerItems> sends,
                                     std::vector<PartnerItems> receives)
    : _communicator(communicator),
      _sends(std::move(sends)),
      _receives(std::move(receives)),
      _sent_items(count_items(_sends, communicator.rank(), communicator.size())),
      _received_items(count_items(_receives, communicator.rank(), communicator.size())) {
  const std::int64_t unmatched =
      communicator.sum(static_cast<std::int64_t>(_sent_items) - static_cast<std::int64_t>(_received_items));
  if (unmatched != 0)
    throw std::logic_error("neighbour exchange: " + std::to_string(unmatched) +
                           " items more are sent than received");
}

void NeighbourExchange::exchange(std::span<const std::byte> out, std::span<std::byte> in) const {
  const session::MessageScope timed;
  const std::size_t out_size = size_of_item(out.size(), _sent_items);
  const std::size_t in_size = size_of_item(in.size(), _received_items);
  session::count_exchange(&ExchangeCounts::neighbour, out.size());
  Transfers transfers(host_communicator(_communicator), tag_neighbours, &MessageCounts::neighbour);
  for (const PartnerItems& partner : _receives) {
    transfers.receive(in.first(partner.items * in_size), partner.rank);
    in = in.subspan(partner.items * in_size);
  }
  for (const PartnerItems& partner : _sends) {
    transfers.send(out.first(partner.items * out_size), partner.rank);
    out = out.subspan(partner.items * out_size);
  }
  transfers.wait();
}

NeighbourExchange NeighbourExchange::reversed() const {
  NeighbourExchange result(_communicator);
  result._sends = _receives;
  result._receives = _sends;
  result._sent_items = _received_items;
  result._received_items = _sent_items;
  return result;
}

}  // namespace aeroloom::parallel
