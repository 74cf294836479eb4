#include "io/hdf5/memory_image.hpp"

#include <algorithm>
#include <cstring>

namespace aeroloom::io::hdf5 {

void MemoryImage::write(std::uint64_t offset, std::span<const std::byte> bytes) {
  if (bytes.empty()) return;
  for (std::size_t done = 0; done < bytes.size();) {
    const std::uint64_t at = offset + done;
    const std::size_t within = at % page_bytes, count = std::min(page_bytes - within, bytes.size() - done);
    std::memcpy(_pages[at / page_bytes].data() + within, bytes.data() + done, count);
    done += count;
  }
  std::uint64_t begin = offset, end = offset + bytes.size();
  auto run = _written.upper_bound(end);
  while (run != _written.begin() && std::prev(run)->second >= begin) {
    run = std::prev(run);
    begin = std::min(begin, run->first);
    end = std::max(end, run->second);
    run = _written.erase(run);
  }
  _written[begin] = end;
}

void MemoryImage::read(std::uint64_t offset, std::span<std::byte> bytes) const {
  for (std::size_t done = 0; done < bytes.size();) {
    const std::uint64_t at = offset + done;
    const std::size_t within = at % page_bytes, count = std::min(page_bytes - within, bytes.size() - done);
    const auto page = _pages.find(at / page_bytes);
    if (page == _pages.end()) {
      std::memset(bytes.data() + done, 0, count);
    } else {
      std::memcpy(bytes.data() + done, page->second.data() + within, count);
    }
    done += count;
  }
}

std::uint64_t MemoryImage::end() const {
  return _written.empty() ? 0 : std::prev(_written.end())->second;
}

std::vector<Extent> MemoryImage::extents() const {
  std::vector<Extent> result;
  for (const auto& [begin, end] : _written) {
    Extent extent{static_cast<std::int64_t>(begin), parallel::Bytes(end - begin)};
    read(begin, extent.content);
    result.push_back(std::move(extent));
  }
  return result;
}

}  // namespace aeroloom::io::hdf5
