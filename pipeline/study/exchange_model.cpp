#include "pipeline/study/exchange_model.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace aeroloom::study {

namespace {

/// Partners around a part of space, where a record of one rank has none. A cell of a grid has as many
/// neighbours.
constexpr double usual_partners = 26;

/// Steps of a collective operation.
double steps_of(int ranks) {
  return std::bit_width(static_cast<unsigned>(ranks - 1));
}

/// Of all bytes that ranks have for each other the part that leaves its rank: (P-1)/P where they are spread
/// at random, less in proportion where fewer did in the record.
double leaving_part(const StageExchanges& exchanges, int recorded, int ranks) {
  const double at_random = (ranks - 1.0) / ranks;
  const auto all = static_cast<double>(exchanges.asked.rendezvous.bytes);
  if (recorded < 2 || all <= 0) return at_random;
  const double then = static_cast<double>(exchanges.sent.rendezvous.bytes) / all;
  return at_random * std::min(1.0, then * recorded / (recorded - 1.0));
}

}  // namespace

double partners_of(const StageExchanges& exchanges, int recorded, int ranks) {
  const bool is_known = exchanges.partners > 0 && recorded > 1;
  return std::min(ranks - 1.0, is_known ? std::max(exchanges.partners, usual_partners) : usual_partners);
}

double exchange_seconds(const StageExchanges& exchanges, int recorded, int ranks, const Network& network) {
  if (ranks < 2) return 0;
  const parallel::ExchangeCounts& asked = exchanges.asked;
  const double steps = steps_of(ranks), others = ranks - 1;
  const auto calls = [](const parallel::Messages& of) { return static_cast<double>(of.count); };
  const auto size = [](const parallel::Messages& of) { return static_cast<double>(of.bytes); };
  double messages = steps * (calls(asked.broadcast) + calls(asked.all_gather) + calls(asked.table) +
                             calls(asked.reduction));
  double bytes = size(asked.broadcast) + size(asked.all_gather) * others / ranks +
                 size(asked.table) * others + size(asked.reduction) * steps;
  // Sizes go up a tree, contents one after another into the root.
  messages += 0.5 * calls(asked.gather) * (steps + others);
  bytes += size(asked.gather) * others / ranks;
  const double partners = partners_of(exchanges, recorded, ranks);
  // Announcements are answered, then all agree that there are no more; contents follow.
  messages += calls(asked.rendezvous) * (2 * steps + 2 * partners);
  bytes += size(asked.rendezvous) / ranks * leaving_part(exchanges, recorded, ranks);
  messages += calls(asked.neighbour) * partners;
  // The borders of parts: more of them by the cube root of their number, each rank with its own.
  bytes += size(asked.neighbour) / ranks * std::cbrt(static_cast<double>(ranks) / std::max(2, recorded));
  return messages * network.latency + bytes / network.bandwidth;
}

}  // namespace aeroloom::study
