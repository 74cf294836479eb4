#include "io/hdf5/file_layout.hpp"

#include "io/hdf5/memory_driver.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace aeroloom::io::hdf5 {

namespace {

hid_t file_type(ItemType type) {
  switch (type) {
    case ItemType::int8:
      return H5T_STD_I8LE;
    case ItemType::uint8:
      return H5T_STD_U8LE;
    case ItemType::int32:
      return H5T_STD_I32LE;
    case ItemType::int64:
      return H5T_STD_I64LE;
    case ItemType::float32:
      return H5T_IEEE_F32LE;
    default:
      return H5T_IEEE_F64LE;
  }
}

Handle text_type(std::size_t bytes, TextKind kind) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "type of texts");
  require(H5Tset_size(type, bytes), "length of texts");
  if (kind == TextKind::null_padded) require(H5Tset_strpad(type, H5T_STR_NULLPAD), "padding of texts");
  return type;
}

Handle space_of(std::span<const std::int64_t> dimensions) {
  std::vector<hsize_t> sizes(dimensions.begin(), dimensions.end());
  return {H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr), H5Sclose,
          "space of an array"};
}

/// Properties of a new object without times, so that equal files have equal bytes.
Handle timeless(hid_t list_class) {
  Handle properties(H5Pcreate(list_class), H5Pclose, "properties of an object");
  require(H5Pset_obj_track_times(properties, false), "times of an object");
  return properties;
}

constexpr unsigned keep_order = H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED;

/// Large arrays begin at pages of the file system.
constexpr hsize_t large_array_bytes = 1 << 16, page_bytes = 4096;

}  // namespace

struct FileLayout::State {
  MemoryImage image;
  MemberOrder order = MemberOrder::by_name;
  Handle file;
  std::int64_t end_of_arrays = 0;  ///< of those reserved

  Handle group_properties() const {
    Handle properties = timeless(H5P_GROUP_CREATE);
    if (order == MemberOrder::as_made)
      require(H5Pset_link_creation_order(properties, keep_order), "order of members");
    return properties;
  }

  Handle create_array(const std::string& path, hid_t type, hid_t space) const {
    const Handle properties = timeless(H5P_DATASET_CREATE);
    require(H5Pset_layout(properties, H5D_CONTIGUOUS), path);
    require(H5Pset_alloc_time(properties, H5D_ALLOC_TIME_EARLY), path);
    // Arrays are written in full. Those of texts hold pointers, and the library insists on filling them.
    if (H5Tget_class(type) != H5T_STRING) require(H5Pset_fill_time(properties, H5D_FILL_TIME_NEVER), path);
    return {H5Dcreate2(file, path.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose,
            "array " + path};
  }

  void set_attribute(const std::string& path, const std::string& name, hid_t type, hid_t space,
                     const void* value) const {
    const Handle object(H5Oopen(file, path.c_str(), H5P_DEFAULT), H5Oclose, path);
    const Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                           "attribute " + name + " of " + path);
    require(H5Awrite(attribute, type, value), "attribute " + name + " of " + path);
  }
};

FileLayout::FileLayout(MemberOrder order) : _state(std::make_unique<State>()) {
  open_library();
  _state->order = order;
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "access properties");
  use_memory_driver(access, _state->image);
  require(H5Pset_alignment(access, large_array_bytes, page_bytes), "alignment");
  const Handle creation = timeless(H5P_FILE_CREATE);
  if (order == MemberOrder::as_made)
    require(H5Pset_link_creation_order(creation, keep_order), "order of members");
  _state->file = Handle(H5Fcreate("layout", H5F_ACC_TRUNC, creation, access), H5Fclose, "a file in memory");
}

FileLayout::FileLayout(FileLayout&&) noexcept = default;
FileLayout::~FileLayout() = default;

void FileLayout::add_group(const std::string& path) {
  const Handle properties = _state->group_properties();
  const Handle group(H5Gcreate2(_state->file, path.c_str(), H5P_DEFAULT, properties, H5P_DEFAULT), H5Gclose,
                     "group " + path);
}

void FileLayout::set_text(const std::string& path, const std::string& attribute, const std::string& text,
                          std::size_t bytes, TextKind kind) {
  parallel::Bytes padded(std::max({bytes, text.size(), std::size_t{1}}));
  std::memcpy(padded.data(), text.data(), text.size());
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "space of a text");
  _state->set_attribute(path, attribute, text_type(padded.size(), kind), space, padded.data());
}

void FileLayout::set_integers(const std::string& path, const std::string& attribute,
                              std::span<const std::int32_t> values) {
  const std::array dimensions = {static_cast<std::int64_t>(values.size())};
  _state->set_attribute(path, attribute, H5T_STD_I32LE, space_of(dimensions), values.data());
}

void FileLayout::store_bytes(const std::string& path, ItemType type, std::span<const std::int64_t> dimensions,
                             std::span<const std::byte> items) {
  std::int64_t expected = bytes_of(type);
  for (const std::int64_t size : dimensions) expected *= size;
  if (expected != static_cast<std::int64_t>(items.size()))
    throw std::logic_error("items of " + path + " are not as many as its dimensions say");
  const Handle array = _state->create_array(path, file_type(type), space_of(dimensions));
  if (items.empty()) return;
  require(H5Dwrite(array, file_type(type), H5S_ALL, H5S_ALL, H5P_DEFAULT, items.data()), path);
}

void FileLayout::store_texts(const std::string& path, std::span<const std::string> texts) {
  if (texts.empty()) return;
  std::vector<const char*> pointers;
  for (const std::string& text : texts) pointers.push_back(text.c_str());
  const Handle type = text_type(H5T_VARIABLE, TextKind::null_terminated);
  const std::array dimensions = {static_cast<std::int64_t>(texts.size())};
  const Handle array = _state->create_array(path, type, space_of(dimensions));
  require(H5Dwrite(array, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()), path);
}

std::int64_t FileLayout::reserve(const std::string& path, ItemType type,
                                 std::span<const std::int64_t> dimensions) {
  std::int64_t bytes = bytes_of(type);
  for (const std::int64_t size : dimensions) bytes *= size;
  const Handle array = _state->create_array(path, file_type(type), space_of(dimensions));
  if (bytes == 0) return 0;
  const haddr_t offset = H5Dget_offset(array);
  if (offset == HADDR_UNDEF) throw std::runtime_error("array " + path + " has no place in the file");
  const auto begin = static_cast<std::int64_t>(offset);
  _state->end_of_arrays = std::max(_state->end_of_arrays, begin + bytes);
  return begin;
}

std::vector<Extent> FileLayout::finish() {
  // The end of the space that the library has given away stands in the file's first bytes: a file that is
  // shorter counts as truncated.
  _state->file.close("cannot close a file in memory");
  std::vector<Extent> structure = _state->image.extents();
  const std::uint64_t space = _state->image.length();
  const auto end = std::max(static_cast<std::uint64_t>(_state->end_of_arrays), _state->image.end());
  if (space > end) structure.push_back({static_cast<std::int64_t>(space) - 1, parallel::Bytes(1)});
  return structure;
}

void write_laid_out(const SharedPath& file, const std::vector<Extent>& structure,
                    const std::function<void(parallel::SharedFile&)>& work) {
  parallel::write_shared_file(file.communicator, file.path, [&](parallel::SharedFile& opened) {
    if (file.communicator.is_root()) {
      for (const Extent& extent : structure) opened.write(extent.offset, extent.content);
    }
    work(opened);
  });
}

}  // namespace aeroloom::io::hdf5
