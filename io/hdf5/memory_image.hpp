/// A file in memory: the bytes that HDF5 writes when it lays out a file.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace aeroloom::io::hdf5 {

/// Some bytes of a file, and their offset.
struct Extent {
  std::int64_t offset = 0;
  parallel::Bytes content;
};

/// A file of any length in which few bytes are written. Only those take memory; all others read as zero.
class MemoryImage {
public:
  void write(std::uint64_t offset, std::span<const std::byte> bytes);
  void read(std::uint64_t offset, std::span<std::byte> bytes) const;
  /// The offset after the last byte that was written.
  std::uint64_t end() const;
  /// The length of the file, which may be larger than end().
  void set_length(std::uint64_t length) { _length = length; }
  std::uint64_t length() const { return _length; }
  /// The written bytes as extents: ascending, without overlap, with gaps between them.
  std::vector<Extent> extents() const;

private:
  std::uint64_t _length = 0;
  static constexpr std::size_t page_bytes = 4096;
  using Page = std::array<std::byte, page_bytes>;

  std::map<std::uint64_t, Page> _pages;             ///< by number of the page
  std::map<std::uint64_t, std::uint64_t> _written;  ///< first offset and end of each extent
};

}  // namespace aeroloom::io::hdf5
