#include "parallel/communication/communicator.hpp"

#include "parallel/communication/message_counting.hpp"
#include "parallel/communication/session.hpp"
#include "parallel/communication/transfers.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace aeroloom::parallel {

using session::check;

namespace {

void broadcast_content(const CommunicatorHandle& handle, std::span<std::byte> bytes, Rank root) {
  for_each_part(bytes.size(), [&](std::size_t offset, int count) {
    check(MPI_Bcast(bytes.data() + offset, count, MPI_BYTE, root, handle.communicator), "broadcasting");
    session::count_broadcast(handle, root, static_cast<std::uint64_t>(count));
  });
}

template <class T>
void reduce_each(const CommunicatorHandle& handle, std::span<T> values, MPI_Datatype type, MPI_Op operation) {
  const session::MessageScope timed;
  for_each_part(values.size(), [&](std::size_t offset, int count) {
    check(MPI_Allreduce(MPI_IN_PLACE, values.data() + offset, count, type, operation, handle.communicator),
          "reducing");
    session::count_reduction(handle, static_cast<std::uint64_t>(count) * sizeof(T));
  });
}

template <class T>
T reduce(const CommunicatorHandle& handle, T value, MPI_Datatype type, MPI_Op operation) {
  reduce_each(handle, std::span(&value, 1), type, operation);
  return value;
}

/// The value of every rank, on every rank.
template <class T>
std::vector<T> all_values(const CommunicatorHandle& handle, T value, MPI_Datatype type) {
  std::vector<T> values(static_cast<std::size_t>(handle.size));
  check(MPI_Allgather(&value, 1, type, values.data(), 1, type, handle.communicator), "gathering values");
  session::count_all_gather_of_equals(handle, sizeof(T));
  return values;
}

/// Of at most largest_part bytes in total.
void all_gather_small(const CommunicatorHandle& handle, std::span<const std::byte> mine,
                      const std::vector<std::uint64_t>& sizes, std::byte* to) {
  std::vector<int> counts(sizes.begin(), sizes.end()), starts(sizes.size());
  int total = 0;
  for (std::size_t r = 0; r < sizes.size(); ++r) {
    starts[r] = total;
    total += counts[r];
  }
  check(MPI_Allgatherv(mine.data(), static_cast<int>(mine.size()), MPI_BYTE, to, counts.data(), starts.data(),
                       MPI_BYTE, handle.communicator),
        "gathering on all ranks");
  session::count_all_gather(handle, sizes);
}

/// Of any size: every rank broadcasts in turn.
void all_gather_large(const CommunicatorHandle& handle, std::span<const std::byte> mine,
                      const std::vector<std::uint64_t>& sizes, std::byte* to) {
  for (std::size_t r = 0; r < sizes.size(); ++r) {
    if (static_cast<Rank>(r) == handle.rank) std::copy(mine.begin(), mine.end(), to);
    broadcast_content(handle, {to, sizes[r]}, static_cast<Rank>(r));
    to += sizes[r];
  }
}

void require_distinct_destinations(const std::vector<Parcel>& outgoing, int ranks) {
  std::vector<char> seen(static_cast<std::size_t>(ranks), 0);
  for (const Parcel& parcel : outgoing) {
    if (parcel.rank < 0 || parcel.rank >= ranks) {
      throw std::logic_error("exchange: there is no rank " + std::to_string(parcel.rank));
    }
    char& destination = seen[static_cast<std::size_t>(parcel.rank)];
    if (destination) throw std::logic_error("exchange: two parcels for rank " + std::to_string(parcel.rank));
    destination = 1;
  }
}

/// Tells the receivers the sizes of the parcels for them, and returns, with contents of the right size but
/// not yet received, those that come here. A synchronous send completes when it is matched, so a rank enters
/// the barrier when its own announcements have arrived; when the barrier completes, all have.
std::vector<Parcel> announce(const CommunicatorHandle& handle, int tag, const std::vector<Parcel>& outgoing) {
  std::vector<std::uint64_t> sizes;
  sizes.reserve(outgoing.size());  // the sends point into it
  std::vector<MPI_Request> sends;
  for (const Parcel& parcel : outgoing) {
    sizes.push_back(parcel.content.size());
    check(MPI_Issend(&sizes.back(), 1, MPI_UINT64_T, parcel.rank, tag, handle.communicator,
                     &sends.emplace_back(MPI_REQUEST_NULL)),
          "announcing a parcel");
    if (parcel.rank != handle.rank) session::count_message(&MessageCounts::rendezvous, sizeof sizes.back());
  }
  std::vector<Parcel> incoming;
  MPI_Request barrier = MPI_REQUEST_NULL;
  bool in_barrier = false;
  for (int complete = 0; !complete;) {
    int arrived = 0;
    MPI_Message message = MPI_MESSAGE_NULL;
    MPI_Status status;
    check(MPI_Improbe(MPI_ANY_SOURCE, tag, handle.communicator, &arrived, &message, &status), "probing");
    if (arrived) {
      std::uint64_t size = 0;
      check(MPI_Mrecv(&size, 1, MPI_UINT64_T, &message, MPI_STATUS_IGNORE), "receiving an announcement");
      // A message to oneself is handed over and not received: no copy is made.
      incoming.push_back({status.MPI_SOURCE, Bytes(status.MPI_SOURCE == handle.rank ? 0 : size)});
    }
    if (in_barrier) {
      check(MPI_Test(&barrier, &complete, MPI_STATUS_IGNORE), "testing the barrier");
      continue;
    }
    int sent = 0;
    check(MPI_Testall(static_cast<int>(sends.size()), sends.data(), &sent, MPI_STATUSES_IGNORE),
          "testing announcements");
    if (sent) {
      check(MPI_Ibarrier(handle.communicator, &barrier), "entering the barrier");
      session::count_consensus(handle);
      in_barrier = true;
    }
  }
  std::sort(incoming.begin(), incoming.end(),
            [](const Parcel& a, const Parcel& b) { return a.rank < b.rank; });
  return incoming;
}

}  // namespace

Communicator Communicator::world() {
  return Communicator(session::world());
}

Communicator Communicator::self() {
  return Communicator(session::self());
}

const CommunicatorHandle& Communicator::handle() const {
  if (!_handle) throw std::logic_error("a communicator of no ranks was used");
  return *_handle;
}

const CommunicatorHandle& Communicator::usable_handle() const {
  if (!session::is_library_running()) {
    throw std::logic_error("a communicator was used after the end of MPI");
  }
  return handle();
}

Rank Communicator::rank() const {
  return handle().rank;
}

int Communicator::size() const {
  return handle().size;
}

void Communicator::barrier() const {
  const session::MessageScope timed;
  const CommunicatorHandle& handle = usable_handle();
  check(MPI_Barrier(handle.communicator), "waiting at a barrier");
  session::count_barrier(handle);
}

void Communicator::broadcast(Bytes& bytes, Rank root) const {
  const session::MessageScope timed;
  const CommunicatorHandle& handle = usable_handle();
  std::uint64_t size = bytes.size();
  check(MPI_Bcast(&size, 1, MPI_UINT64_T, root, handle.communicator), "broadcasting a size");
  session::count_broadcast(handle, root, sizeof size);
  bytes.resize(size);
  broadcast_content(handle, bytes, root);
}

std::vector<std::uint64_t> Communicator::all_sizes(std::uint64_t mine) const {
  const session::MessageScope timed;
  return all_values<std::uint64_t>(usable_handle(), mine, MPI_UINT64_T);
}

void Communicator::all_gather_into(std::span<const std::byte> mine, const std::vector<std::uint64_t>& sizes,
                                   std::byte* to) const {
  const session::MessageScope timed;
  const CommunicatorHandle& handle = usable_handle();
  const std::uint64_t total = std::accumulate(sizes.begin(), sizes.end(), std::uint64_t{0});
  total <= largest_part ? all_gather_small(handle, mine, sizes, to)
                        : all_gather_large(handle, mine, sizes, to);
}

std::vector<Bytes> Communicator::all_gather(const Bytes& mine) const {
  const std::vector<std::uint64_t> sizes = all_sizes(mine.size());
  Bytes joint(std::accumulate(sizes.begin(), sizes.end(), std::uint64_t{0}));
  all_gather_into(mine, sizes, joint.data());
  std::vector<Bytes> all;
  const std::byte* next = joint.data();
  for (const std::uint64_t size : sizes) {
    all.emplace_back(next, next + size);
    next += size;
  }
  return all;
}

std::vector<Bytes> Communicator::gather(const Bytes& mine, Rank root) const {
  const session::MessageScope timed;
  const CommunicatorHandle& handle = usable_handle();
  const bool receives = handle.rank == root;
  const std::uint64_t size = mine.size();
  std::vector<std::uint64_t> sizes(receives ? static_cast<std::size_t>(handle.size) : 0);
  check(MPI_Gather(&size, 1, MPI_UINT64_T, sizes.data(), 1, MPI_UINT64_T, root, handle.communicator),
        "gathering sizes");
  session::count_gather(handle, root, sizeof size);
  session::count_exchange(&ExchangeCounts::gather, size);
  Transfers transfers(handle.communicator, tag_content, &MessageCounts::collective);
  std::vector<Bytes> all(sizes.size());
  if (receives) {
    for (Rank r = 0; r < handle.size; ++r) {
      Bytes& part = all[static_cast<std::size_t>(r)];
      if (r == root) {
        part = mine;
      } else {
        part.resize(sizes[static_cast<std::size_t>(r)]);
        transfers.receive(part, r);
      }
    }
  } else {
    transfers.send(mine, root);
  }
  transfers.wait();
  return all;
}

std::vector<Parcel> Communicator::exchange(std::vector<Parcel> outgoing) const {
  const session::MessageScope timed;
  const CommunicatorHandle& handle = usable_handle();
  require_distinct_destinations(outgoing, handle.size);
  // A rank can leave the consensus and start the next one while another has not yet noticed the end of this
  // one, but nobody can be two ahead: two alternating tags keep them apart.
  const int tag = tag_consensus + static_cast<int>(_handle->exchanges++ % 2);
  std::uint64_t handed_over = 0;
  for (const Parcel& parcel : outgoing) handed_over += parcel.content.size();
  session::count_exchange(&ExchangeCounts::rendezvous, handed_over);
  std::vector<Parcel> incoming = announce(handle, tag, outgoing);
  Transfers transfers(handle.communicator, tag_content, &MessageCounts::rendezvous);
  for (Parcel& parcel : incoming) {
    if (parcel.rank != handle.rank) transfers.receive(parcel.content, parcel.rank);
  }
  for (Parcel& parcel : outgoing) {
    if (parcel.rank != handle.rank) {
      transfers.send(parcel.content, parcel.rank);
      continue;
    }
    const auto own = std::find_if(incoming.begin(), incoming.end(),
                                  [&](const Parcel& candidate) { return candidate.rank == handle.rank; });
    own->content = std::move(parcel.content);
  }
  transfers.wait();
  return incoming;
}

std::int64_t Communicator::sum(std::int64_t value) const {
  return reduce(usable_handle(), value, MPI_INT64_T, MPI_SUM);
}

std::int64_t Communicator::minimum(std::int64_t value) const {
  return reduce(usable_handle(), value, MPI_INT64_T, MPI_MIN);
}

std::int64_t Communicator::maximum(std::int64_t value) const {
  return reduce(usable_handle(), value, MPI_INT64_T, MPI_MAX);
}

std::int64_t Communicator::exclusive_scan(std::int64_t value) const {
  const session::MessageScope timed;
  const CommunicatorHandle& handle = usable_handle();
  std::int64_t before = 0;
  check(MPI_Exscan(&value, &before, 1, MPI_INT64_T, MPI_SUM, handle.communicator), "scanning");
  session::count_scan(handle, sizeof value);
  return handle.rank == 0 ? 0 : before;  // the library leaves it undefined there
}

double Communicator::minimum(double value) const {
  return reduce(usable_handle(), value, MPI_DOUBLE, MPI_MIN);
}

double Communicator::maximum(double value) const {
  return reduce(usable_handle(), value, MPI_DOUBLE, MPI_MAX);
}

void Communicator::sum_each(std::span<std::int64_t> values) const {
  reduce_each(usable_handle(), values, MPI_INT64_T, MPI_SUM);
}

void Communicator::minimum_each(std::span<double> values) const {
  reduce_each(usable_handle(), values, MPI_DOUBLE, MPI_MIN);
}

double Communicator::sum(double value) const {
  const session::MessageScope timed;
  double total = 0;
  for (const double part : all_values(usable_handle(), value, MPI_DOUBLE)) total += part;
  return total;
}

}  // namespace aeroloom::parallel
