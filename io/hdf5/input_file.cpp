#include "io/hdf5/input_file.hpp"

#include "geometry/input_file.hpp"
#include "io/hdf5/sandboxed_reading.hpp"
#include "parallel/sandbox/crash_note.hpp"
#include "parallel/sandbox/sandbox.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::io::hdf5 {

namespace {

constexpr std::int64_t rows_at_a_time = std::int64_t{1} << 21;
// Of a child that reads so many rows: many times what they take where the file is sound. Chosen, not
// measured.
constexpr double most_cpu_seconds = 120;
constexpr std::int64_t most_bytes = std::int64_t{2} << 30;

/// Runs one operation in a child; its bytes.
parallel::Bytes read_sandboxed(const ReadingRequest& request) {
  const std::string& path = request.path;
  parallel::SandboxLimits limits;
  limits.cpu_seconds = most_cpu_seconds;
  limits.address_space_bytes = most_bytes;
  const parallel::CrashNote note(fmt::format("reading '{}'", path));
  parallel::SandboxResult result =
      parallel::run_sandboxed(reading_task.name(), parallel::to_wire(request), limits);
  switch (result.status) {
    case parallel::SandboxStatus::ok:
      return std::move(result.output);
    case parallel::SandboxStatus::threw:
      throw std::runtime_error(path + ": " + result.message);
    case parallel::SandboxStatus::out_of_memory:
      throw std::runtime_error(path +
                               ": the HDF5 library ran out of memory on it; the file is damaged, or has "
                               "chunks above a GiB (h5repack)");
    case parallel::SandboxStatus::out_of_time:
      throw std::runtime_error(path + ": the HDF5 library came to no end with it; the file is damaged");
    default:
      throw std::runtime_error(
          fmt::format("{}: the HDF5 library crashed on it ({}); the file is damaged", path, result.message));
  }
}

template <class T>
std::vector<T> read_rows(const std::string& path, Operation operation, const std::string& array,
                         std::int64_t begin, std::int64_t count) {
  std::vector<T> items;
  for (std::int64_t done = 0; done < count; done += rows_at_a_time) {
    const RowRange range{array, begin + done, std::min(rows_at_a_time, count - done)};
    const parallel::Bytes bytes = read_sandboxed({operation, path, parallel::to_wire(range)});
    const std::vector<T> portion = parallel::from_bytes<T>(bytes);
    items.insert(items.end(), portion.begin(), portion.end());
  }
  return items;
}

}  // namespace

InputFile::InputFile(std::string path) : _path(std::move(path)) {
  geometry::require_readable(_path);
}

Survey InputFile::survey(const SurveyRequest& request) const {
  return parallel::from_wire<Survey>(read_sandboxed({Operation::survey, _path, parallel::to_wire(request)}));
}

std::vector<std::int64_t> InputFile::integers(const std::string& array, std::int64_t begin,
                                              std::int64_t count) const {
  return read_rows<std::int64_t>(_path, Operation::integers, array, begin, count);
}

std::vector<double> InputFile::reals(const std::string& array, std::int64_t begin, std::int64_t count) const {
  return read_rows<double>(_path, Operation::reals, array, begin, count);
}

std::vector<std::string> InputFile::texts(const std::string& array) const {
  return parallel::from_wire<std::vector<std::string>>(
      read_sandboxed({Operation::texts, _path, parallel::to_wire(array)}));
}

}  // namespace aeroloom::io::hdf5
