/// The bytes that HDF5 writes of a file that is laid out in memory.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace aeroloom::io::hdf5 {

/// Bytes of a file at an offset.
struct Extent {
  std::int64_t offset = 0;
  parallel::Bytes content;
};

/// A file of any length of which few bytes are written: those are kept, the others read as zero.
class MemoryImage {
public:
  void write(std::uint64_t offset, std::span<const std::byte> bytes);
  void read(std::uint64_t offset, std::span<std::byte> bytes) const;
  /// After the last byte written.
  std::uint64_t end() const;
  /// Of the file, as its owner says; no byte of it need be written.
  void set_length(std::uint64_t length) { _length = length; }
  std::uint64_t length() const { return _length; }
  /// The extents that have been written, and nothing between: ascending, neither overlapping nor touching.
  std::vector<Extent> extents() const;

private:
  std::uint64_t _length = 0;
  static constexpr std::size_t page_bytes = 4096;
  using Page = std::array<std::byte, page_bytes>;

  std::map<std::uint64_t, Page> _pages;             ///< by number
  std::map<std::uint64_t, std::uint64_t> _written;  ///< beginning and end of runs of bytes
};

}  // namespace aeroloom::io::hdf5
