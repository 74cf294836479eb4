/// Writes HDF5 files in parallel without the parallel HDF5 library. Every rank lays out the same file in
/// memory. So each rank knows the offset of its items in every array, and writes them there as plain bytes.
///
/// The library never opens the file itself. A failure of the file system is an error of one write, and the
/// bytes do not depend on the number of ranks. (HDF5 over MPI crashes where a file cannot be closed, as on a
/// full disk: H5F__close_cb, tried with 1.10.8.)
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

/// Types of items in files, all little-endian.
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

/// The order of the members of a group: by name, or as they were created.
enum class MemberOrder { by_name, as_made };

/// How a text ends that is shorter than its room.
enum class TextKind { null_terminated, null_padded };

/// The layout of a file. Paths are absolute. All throw std::runtime_error with the reason of the library.
class FileLayout {
public:
  explicit FileLayout(MemberOrder order = MemberOrder::by_name);
  FileLayout(FileLayout&&) noexcept;
  ~FileLayout();

  /// The parent group must exist.
  void add_group(const std::string& path);
  /// Sets a text attribute of a group or an array, with room for `bytes` bytes; 0: as many as the text has.
  void set_text(const std::string& path, const std::string& attribute, const std::string& text,
                std::size_t bytes = 0, TextKind kind = TextKind::null_terminated);
  /// Sets an attribute of one dimension.
  void set_integers(const std::string& path, const std::string& attribute,
                    std::span<const std::int32_t> values);

  /// Adds an array with its items. The last dimension runs fastest.
  void store_bytes(const std::string& path, ItemType type, std::span<const std::int64_t> dimensions,
                   std::span<const std::byte> items);
  template <class T>
  void store(const std::string& path, std::span<const T> items) {
    const std::array dimensions = {static_cast<std::int64_t>(items.size())};
    store_bytes(path, item_type<T>, dimensions, std::as_bytes(items));
  }
  /// Adds an array of texts of any length. The bytes are UTF-8 and the type says ASCII, because VTK 9.1 reads
  /// no other type. Without texts there is no array.
  void store_texts(const std::string& path, std::span<const std::string> texts);

  /// Adds an array that ranks fill later. Returns the offset of its first item in the file. Takes no memory.
  std::int64_t reserve(const std::string& path, ItemType type, std::span<const std::int64_t> dimensions);
  std::int64_t reserve(const std::string& path, ItemType type, std::int64_t count) {
    return reserve(path, type, std::array{count});
  }

  /// All bytes of the file without the reserved arrays. Nothing can be added afterwards.
  std::vector<Extent> finish();

private:
  struct State;
  std::unique_ptr<State> _state;
};

/// Writes a file (parallel::write_shared_file). Rank 0 writes the structure; `work` writes the items of this
/// rank in the reserved arrays. Collective.
void write_laid_out(const SharedPath& file, const std::vector<Extent>& structure,
                    const std::function<void(parallel::SharedFile&)>& work);

}  // namespace aeroloom::io::hdf5
