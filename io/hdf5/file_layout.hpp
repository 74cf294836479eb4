/// An HDF5 file laid out in memory: every rank lays out the same one, so that each knows where its share of
/// every array goes and writes it there as plain bytes.
///
/// The library itself never touches the file, so whatever the file system does to one rank is an error of
/// that write, and the bytes are those of the layout whatever the number of ranks. (Its own way over MPI ends
/// in a crash where a file cannot be closed, as on a full disk: H5F__close_cb, tried with 1.10.8.)
#pragma once

#include "io/hdf5/memory_image.hpp"
#include "io/shared_path.hpp"
#include "parallel/storage/shared_file.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace aeroloom::io::hdf5 {

/// Items in files: all of little-endian machines.
enum class ItemType { int8, uint8, int32, int64, float32, float64 };
inline constexpr std::array<int, 6> item_type_bytes = {1, 1, 4, 8, 4, 8};
inline constexpr int bytes_of(ItemType type) {
  return item_type_bytes[static_cast<std::size_t>(type)];
}
template <class T>
inline constexpr ItemType item_type = sizeof(T) == 4 ? ItemType::int32 : ItemType::int64;
template <>
inline constexpr ItemType item_type<double> = ItemType::float64;
template <>
inline constexpr ItemType item_type<std::int8_t> = ItemType::int8;
template <>
inline constexpr ItemType item_type<std::uint8_t> = ItemType::uint8;

/// Whether groups remember the order in which their members came.
enum class MemberOrder { by_name, as_made };

/// How the bytes of a text without an end mark are filled up.
enum class TextKind { null_terminated, null_padded };

/// Paths are absolute. All throw std::runtime_error with the library's reason.
class FileLayout {
public:
  explicit FileLayout(MemberOrder order = MemberOrder::by_name);
  FileLayout(FileLayout&&) noexcept;
  ~FileLayout();

  /// The group it lies in must be there.
  void add_group(const std::string& path);
  /// Of a group or an array: `bytes` of room, 0: as many as it needs.
  void set_text(const std::string& path, const std::string& attribute, const std::string& text,
                std::size_t bytes = 0, TextKind kind = TextKind::null_terminated);
  /// An attribute of one dimension.
  void set_integers(const std::string& path, const std::string& attribute,
                    std::span<const std::int32_t> values);

  /// An array whose items are known now, of dimensions whose last one runs fastest.
  void store_bytes(const std::string& path, ItemType type, std::span<const std::int64_t> dimensions,
                   std::span<const std::byte> items);
  template <class T>
  void store(const std::string& path, std::span<const T> items) {
    const std::array dimensions = {static_cast<std::int64_t>(items.size())};
    store_bytes(path, item_type<T>, dimensions, std::as_bytes(items));
  }
  /// Texts of any length, in the library's own heap. Their bytes are UTF-8, their type says ASCII: VTK 9.1
  /// reads no others. No texts: no array.
  void store_texts(const std::string& path, std::span<const std::string> texts);

  /// An array that ranks fill later; the offset of its first item in the file. Takes no memory.
  std::int64_t reserve(const std::string& path, ItemType type, std::span<const std::int64_t> dimensions);
  std::int64_t reserve(const std::string& path, ItemType type, std::int64_t count) {
    return reserve(path, type, std::array{count});
  }

  /// All bytes of the file but those of arrays that were reserved. Nothing can be added afterwards.
  std::vector<Extent> finish();

private:
  struct State;
  std::unique_ptr<State> _state;
};

/// Writes a file (parallel::write_shared_file): rank 0 the structure, every rank by `work` its share of what
/// was reserved. Collective.
void write_laid_out(const SharedPath& file, const std::vector<Extent>& structure,
                    const std::function<void(parallel::SharedFile&)>& work);

}  // namespace aeroloom::io::hdf5
