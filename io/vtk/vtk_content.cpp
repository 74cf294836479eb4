#include "io/vtk/vtk_content.hpp"

#include "geometry/input_file.hpp"
#include "parallel/sandbox/crash_note.hpp"
#include "parallel/sandbox/sandbox.hpp"

#include <filesystem>
#include <span>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

/// Compressed arrays and text grow in memory, but not beyond measure. Chosen, not measured: many times what
/// files take that are sound.
parallel::SandboxLimits limits_of(std::int64_t file_bytes) {
  constexpr double base_seconds = 10, seconds_per_byte = 4e-6;
  constexpr std::int64_t base_bytes = std::int64_t{1} << 30, bytes_per_byte = 100;
  parallel::SandboxLimits limits;
  limits.cpu_seconds = base_seconds + seconds_per_byte * static_cast<double>(file_bytes);
  limits.address_space_bytes = base_bytes + bytes_per_byte * file_bytes;
  return limits;
}

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

parallel::Bytes run_content_task(std::span<const std::byte> input) {
  return parallel::hand_over_to_wire(extract_vtk_content(text_of(input)));
}

parallel::Bytes run_sources_task(std::span<const std::byte> input) {
  return parallel::to_wire(extract_vtk_sources(text_of(input)));
}

const parallel::NamedTask content_task("read a VTK file", run_content_task);
const parallel::NamedTask sources_task("read an index of VTK files", run_sources_task);

parallel::Bytes run_reader(const parallel::NamedTask& task, const std::string& path) {
  const parallel::SandboxLimits limits = limits_of(readable_bytes(path));
  const parallel::CrashNote note(fmt::format("reading '{}'", path));
  parallel::SandboxResult result =
      parallel::run_sandboxed(task.name(), std::as_bytes(std::span(path)), limits);
  switch (result.status) {
    case parallel::SandboxStatus::ok:
      return std::move(result.output);
    case parallel::SandboxStatus::threw:
      throw std::runtime_error(fmt::format("'{}': {}", path, result.message));
    case parallel::SandboxStatus::out_of_memory:
      throw std::runtime_error(
          fmt::format("'{}': VTK's reader asks for more than {} MiB of memory, too much for a file of this "
                      "size; it is damaged, or compressed beyond measure",
                      path, limits.address_space_bytes >> 20));
    case parallel::SandboxStatus::out_of_time:
      throw std::runtime_error(fmt::format("'{}': VTK's reader does not end within {:.0f} s; it is damaged",
                                           path, limits.cpu_seconds));
    case parallel::SandboxStatus::aborted:
      break;
  }
  throw std::runtime_error(
      fmt::format("'{}': VTK's reader crashes on it ({}); it is damaged", path, result.message));
}

}  // namespace

std::int64_t readable_bytes(const std::string& path) {
  namespace fs = std::filesystem;
  geometry::require_readable(path);
  return fs::is_regular_file(path) ? static_cast<std::int64_t>(fs::file_size(path)) : 0;
}

VtkContent read_vtk_content(const std::string& path) {
  return parallel::from_wire<VtkContent>(run_reader(content_task, path));
}

std::vector<std::string> read_vtk_sources(const std::string& path) {
  return parallel::from_wire<std::vector<std::string>>(run_reader(sources_task, path));
}

}  // namespace aeroloom::io
