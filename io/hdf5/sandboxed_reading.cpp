#include "io/hdf5/sandboxed_reading.hpp"

#include "io/hdf5/handle.hpp"
#include "io/hdf5/input_file.hpp"
#include "parallel/sandbox/sandbox.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::io::hdf5 {

using parallel::Bytes;

namespace {

/// Deflate cannot do better than 1,032 to 1.
constexpr std::int64_t best_compression = 1100;
/// Texts of a table together.
constexpr std::int64_t most_text_bytes = std::int64_t{1} << 26;

Handle open_file(const std::string& path) {
  open_library();
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "access properties");
#if H5_VERSION_GE(1, 10, 7)
  // Nothing else writes here, and not every file system can lock.
  require(H5Pset_file_locking(access, false, true), "locks");
#endif
  const htri_t is_hdf5 = H5Fis_hdf5(path.c_str());
  if (is_hdf5 == 0) throw std::runtime_error("no HDF5 file: its first bytes are others");
  Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access), H5Fclose, "cannot be opened as HDF5");
  haddr_t end = 0;
  require(H5Fget_eoa(file, &end), "end of the file");
  const auto bytes = std::filesystem::file_size(path);
  if (bytes > end) {
    throw std::runtime_error(
        fmt::format("the file says that it ends at byte {}, but {} bytes follow; it is "
                    "damaged (h5repack writes a sound file anew)",
                    end, bytes - end));
  }
  return file;
}

/// What a link leads to outside of the file; empty until one was met.
struct OtherFile {
  std::string name;
};

/// The library calls it before it follows a link to another file: no file but the one that was given is read.
herr_t refuse_link(const char*, const char*, const char* file, const char*, unsigned*, hid_t, void* context) {
  static_cast<OtherFile*>(context)->name = file;
  return -1;
}

/// Throws std::runtime_error where the path leads to another file, by whatever link. -1: there is none.
Handle open_object(hid_t file, const std::string& path) {
  OtherFile other;
  const Handle access(H5Pcreate(H5P_LINK_ACCESS), H5Pclose, "access properties");
  require(H5Pset_elink_cb(access, refuse_link, &other), "links");
  const hid_t id = H5Oopen(file, path.c_str(), access);
  if (!other.name.empty()) {
    throw std::runtime_error(
        fmt::format("{} is a link to another file, '{}'; copy what it leads to into "
                    "this one (h5copy -f ext)",
                    path, other.name));
  }
  return id < 0 ? Handle() : Handle(id, H5Oclose, path);
}

Handle open_array(hid_t file, const std::string& name) {
  Handle array = open_object(file, name);
  if (array < 0 || H5Iget_type(array) != H5I_DATASET)
    throw std::runtime_error("array " + name + " is not there");
  return array;
}

std::vector<std::int64_t> dimensions_of(hid_t space, const std::string& name) {
  const int rank = require(H5Sget_simple_extent_ndims(space), name);
  if (rank > 2)
    throw std::runtime_error(fmt::format("array {} has {} dimensions, not one or two", name, rank));
  std::vector<hsize_t> sizes(static_cast<std::size_t>(rank));
  require(H5Sget_simple_extent_dims(space, sizes.data(), nullptr), name);
  constexpr hsize_t largest = std::numeric_limits<std::int64_t>::max();
  for (const hsize_t size : sizes) {
    if (size > largest) throw std::runtime_error(fmt::format("array {} has {} rows", name, size));
  }
  return {sizes.begin(), sizes.end()};
}

ItemKind item_kind_of(hid_t array, const std::string& name) {
  const Handle type(H5Dget_type(array), H5Tclose, name);
  switch (H5Tget_class(type)) {
    case H5T_INTEGER:
      return ItemKind::integer;
    case H5T_FLOAT:
      return ItemKind::real;
    case H5T_STRING:
      return ItemKind::text;
    default:
      return ItemKind::other;
  }
}

/// The bytes that an array can hold by what the file stores of it.
std::int64_t credible_bytes(hid_t array, std::int64_t file_bytes, const std::string& name) {
  const Handle properties(H5Dget_create_plist(array), H5Pclose, name);
  if (H5Pget_external_count(properties) > 0 || H5Pget_layout(properties) == H5D_VIRTUAL)
    throw std::runtime_error("array " + name + " lies in other files; copy it into this one (h5repack)");
  const auto stored = static_cast<std::int64_t>(
      std::min<hsize_t>(H5Dget_storage_size(array), static_cast<hsize_t>(file_bytes)));
  return H5Pget_nfilters(properties) > 0 ? stored * best_compression : stored;
}

ArrayFacts facts_of(hid_t file, const std::string& name, std::int64_t file_bytes) {
  ArrayFacts facts;
  const Handle object = open_object(file, name);
  if (object < 0) return facts;
  facts.kind = ItemKind::other;
  if (H5Iget_type(object) != H5I_DATASET) return facts;
  facts.kind = item_kind_of(object, name);
  const Handle space(H5Dget_space(object), H5Sclose, name);
  facts.dimensions = dimensions_of(space, name);
  const Handle type(H5Dget_type(object), H5Tclose, name);
  auto bytes = static_cast<std::int64_t>(H5Tget_size(type));
  bool overflow = bytes <= 0;
  for (const std::int64_t size : facts.dimensions) overflow |= __builtin_mul_overflow(bytes, size, &bytes);
  if (overflow || bytes > credible_bytes(object, file_bytes, name)) {
    throw std::runtime_error(
        fmt::format("array {} claims {} rows, more than the {} bytes of the file can hold; it is damaged or "
                    "was never written",
                    name, facts.rows(), file_bytes));
  }
  return facts;
}

/// A text attribute, fixed or not; an integer's digits; empty for anything else.
std::string attribute_of(hid_t object, const std::string& name) {
  if (H5Aexists(object, name.c_str()) <= 0) return "";
  const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, name);
  const Handle type(H5Aget_type(attribute), H5Tclose, name);
  const Handle space(H5Aget_space(attribute), H5Sclose, name);
  const hssize_t items = H5Sget_simple_extent_npoints(space);
  if (items < 1 || items > 64) return "";
  if (H5Tget_class(type) == H5T_INTEGER) {
    std::vector<std::int64_t> values(static_cast<std::size_t>(items));
    require(H5Aread(attribute, H5T_NATIVE_INT64, values.data()), name);
    return std::to_string(values[0]);
  }
  if (H5Tget_class(type) != H5T_STRING || items != 1) return "";
  if (require(H5Tis_variable_str(type), name) > 0) {
    char* text = nullptr;
    require(H5Aread(attribute, type, static_cast<void*>(&text)), name);
    std::string result = text == nullptr ? "" : text;
    H5free_memory(text);
    return result;
  }
  const std::size_t bytes = H5Tget_size(type);
  if (bytes > most_text_bytes) return "";
  std::string text(bytes, '\0');
  require(H5Aread(attribute, type, text.data()), name);
  return text.substr(0, text.find('\0'));
}

struct MarkSearch {
  AttributeName mark;
  std::string found;
  std::string problem;  ///< with a member
};

herr_t look_for_mark(hid_t group, const char* name, const H5L_info_t*, void* context) {
  auto& search = *static_cast<MarkSearch*>(context);
  try {
    const Handle object = open_object(group, name);
    if (object >= 0 && attribute_of(object, search.mark.attribute) == search.mark.object) search.found = name;
  } catch (const std::exception& error) {
    search.problem = error.what();
    return -1;
  }
  return search.found.empty() ? 0 : 1;
}

Bytes survey(const std::string& path, hid_t file, const SurveyRequest& request) {
  const auto file_bytes = static_cast<std::int64_t>(std::filesystem::file_size(path));
  Survey survey;
  for (const std::string& array : request.arrays) survey.arrays.push_back(facts_of(file, array, file_bytes));
  for (const AttributeName& name : request.attributes) {
    const Handle object = open_object(file, name.object);
    survey.attributes.push_back(object < 0 ? "" : attribute_of(object, name.attribute));
  }
  MarkSearch search{request.mark, "", ""};
  const Handle group = open_object(file, request.group);
  if (group >= 0 && H5Iget_type(group) == H5I_GROUP) {
    const herr_t looked = H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, look_for_mark, &search);
    if (!search.problem.empty())
      throw std::runtime_error("members of " + request.group + ": " + search.problem);
    require(looked, "members of " + request.group);
  }
  survey.marked = search.found;
  return parallel::to_wire(survey);
}

template <class T>
Bytes rows(hid_t file, const RowRange& range, hid_t type) {
  const auto& [name, begin, count] = range;
  const Handle array = open_array(file, name);
  const Handle space(H5Dget_space(array), H5Sclose, name);
  const std::vector<std::int64_t> dimensions = dimensions_of(space, name);
  if (dimensions.empty() || begin < 0 || count < 0 || begin > dimensions[0] - count)
    throw std::runtime_error(fmt::format("array {} has no rows {} to {}", name, begin, begin + count - 1));
  const std::int64_t columns = dimensions.size() > 1 ? dimensions[1] : 1;
  const std::array<hsize_t, 2> first = {static_cast<hsize_t>(begin), 0};
  const std::array<hsize_t, 2> size = {static_cast<hsize_t>(count), static_cast<hsize_t>(columns)};
  Bytes bytes(static_cast<std::size_t>(count * columns) * sizeof(T));
  if (bytes.empty()) return bytes;
  require(H5Sselect_hyperslab(space, H5S_SELECT_SET, first.data(), nullptr, size.data(), nullptr), name);
  const Handle memory(H5Screate_simple(static_cast<int>(dimensions.size()), size.data(), nullptr), H5Sclose,
                      name);
  require(H5Dread(array, type, memory, space, H5P_DEFAULT, bytes.data()),
          fmt::format("rows {} to {} of array {} cannot be read", begin, begin + count - 1, name));
  return bytes;
}

/// Frees what the library has allocated for texts.
struct TextTable {
  explicit TextTable(std::size_t count) : pointers(count) {}
  ~TextTable() {
    for (char* text : pointers) H5free_memory(text);
  }
  TextTable(const TextTable&) = delete;
  TextTable& operator=(const TextTable&) = delete;
  std::vector<char*> pointers;
};

Bytes texts(hid_t file, const std::string& name) {
  const Handle array = open_array(file, name);
  const Handle type(H5Dget_type(array), H5Tclose, name);
  const Handle space(H5Dget_space(array), H5Sclose, name);
  const std::vector<std::int64_t> dimensions = dimensions_of(space, name);
  const std::int64_t count = dimensions.empty() ? 1 : dimensions[0];
  const auto bytes = static_cast<std::int64_t>(H5Tget_size(type));
  if (H5Tget_class(type) != H5T_STRING || dimensions.size() > 1 || bytes <= 0 ||
      count > most_text_bytes / bytes)
    throw std::runtime_error("array " + name + " is no list of texts");
  std::vector<std::string> texts;
  if (require(H5Tis_variable_str(type), name) > 0) {
    TextTable table(static_cast<std::size_t>(count));
    require(H5Dread(array, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, static_cast<void*>(table.pointers.data())),
            name);
    for (const char* text : table.pointers) texts.emplace_back(text == nullptr ? "" : text);
    return parallel::to_wire(texts);
  }
  std::string table(static_cast<std::size_t>(count * bytes), '\0');
  require(H5Dread(array, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, table.data()), name);
  for (std::int64_t i = 0; i < count; ++i) {
    const std::string text =
        table.substr(static_cast<std::size_t>(i * bytes), static_cast<std::size_t>(bytes));
    texts.push_back(text.substr(0, text.find('\0')));
  }
  return parallel::to_wire(texts);
}

Bytes run_request(std::span<const std::byte> input) {
  const auto request = parallel::from_wire<ReadingRequest>(input);
  const std::span<const std::byte> details = request.details;
  const Handle file = open_file(request.path);
  switch (request.operation) {
    case Operation::survey:
      return survey(request.path, file, parallel::from_wire<SurveyRequest>(details));
    case Operation::integers:
      return rows<std::int64_t>(file, parallel::from_wire<RowRange>(details), H5T_NATIVE_INT64);
    case Operation::reals:
      return rows<double>(file, parallel::from_wire<RowRange>(details), H5T_NATIVE_DOUBLE);
    default:
      return texts(file, parallel::from_wire<std::string>(details));
  }
}

}  // namespace

const parallel::NamedTask reading_task("reading HDF5", run_request);

}  // namespace aeroloom::io::hdf5
