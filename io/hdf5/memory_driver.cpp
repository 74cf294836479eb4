#include "io/hdf5/memory_driver.hpp"

#include <cstring>
#include <new>

#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h>
#endif

namespace aeroloom::io::hdf5 {

namespace {

/// An open file. The library knows it by its first member.
struct MemoryFile {
  H5FD_t base;
  MemoryImage* image;
};

MemoryFile& file_of(H5FD_t* file) {
  return *reinterpret_cast<MemoryFile*>(file);
}
const MemoryFile& file_of(const H5FD_t* file) {
  return *reinterpret_cast<const MemoryFile*>(file);
}

H5FD_t* open_image(const char*, unsigned, hid_t access, haddr_t) {
  const void* info = H5Pget_driver_info(access);
  if (info == nullptr) return nullptr;
  auto* file = new (std::nothrow) MemoryFile{};
  if (file == nullptr) return nullptr;
  file->image = *static_cast<MemoryImage* const*>(info);
  return &file->base;
}

herr_t close_file(H5FD_t* file) {
  delete &file_of(file);
  return 0;
}

herr_t query(const H5FD_t*, unsigned long* features) {
  *features = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_AGGREGATE_SMALLDATA;
  return 0;
}

haddr_t end_of_space(const H5FD_t* file, H5FD_mem_t) {
  return file_of(file).image->length();
}

herr_t set_end_of_space(H5FD_t* file, H5FD_mem_t, haddr_t end) {
  file_of(file).image->set_length(end);
  return 0;
}

haddr_t end_of_file(const H5FD_t* file, H5FD_mem_t) {
  return file_of(file).image->end();
}

herr_t read_bytes(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t offset, std::size_t size, void* to) {
  file_of(file).image->read(offset, {static_cast<std::byte*>(to), size});
  return 0;
}

herr_t write_bytes(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t offset, std::size_t size, const void* from) {
  try {
    file_of(file).image->write(offset, {static_cast<const std::byte*>(from), size});
    return 0;
  } catch (const std::bad_alloc&) {
    return -1;
  }
}

H5FD_class_t driver_class() {
  H5FD_class_t driver{};
#if H5_VERSION_GE(1, 13, 0)
  driver.version = H5FD_CLASS_VERSION;
  driver.value = static_cast<H5FD_class_value_t>(H5_VFD_RESERVED + 1);
#endif
  driver.name = "aeroloom_memory";
  driver.maxaddr = (haddr_t{1} << 62) - 1;
  driver.fc_degree = H5F_CLOSE_STRONG;
  driver.fapl_size = sizeof(void*);  // of the image
  driver.open = open_image;
  driver.close = close_file;
  driver.query = query;
  driver.get_eoa = end_of_space;
  driver.set_eoa = set_end_of_space;
  driver.get_eof = end_of_file;
  driver.read = read_bytes;
  driver.write = write_bytes;
  constexpr H5FD_mem_t two_lists[H5FD_MEM_NTYPES] = H5FD_FLMAP_DICHOTOMY;
  std::memcpy(driver.fl_map, two_lists, sizeof two_lists);
  return driver;
}

}  // namespace

void use_memory_driver(hid_t access, MemoryImage& image) {
  static const H5FD_class_t driver = driver_class();
  static const hid_t id = require(H5FDregister(&driver), "cannot add a driver to HDF5");
  const MemoryImage* const info = &image;
  require(H5Pset_driver(access, id, static_cast<const void*>(&info)), "cannot choose a driver of HDF5");
}

}  // namespace aeroloom::io::hdf5
