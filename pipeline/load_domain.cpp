#include "pipeline/load_domain.hpp"

#include "cad/model/step_trace.hpp"
#include "parallel/collective_error.hpp"
#include "parallel/contained.hpp"
#include "pipeline/domain_bytes.hpp"

#include <atomic>
#include <cstdio>
#include <filesystem>
#include <ios>
#include <optional>

#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

using cad::DomainOptions;
using parallel::Bytes;
using parallel::Packer;
using parallel::Sabotage;
using parallel::Unpacker;

const char* const prepare_task_name = "geometry.prepare";
const char* const diagnose_task_name = "geometry.diagnose";
const char* const look_task_name = "geometry.look";

// Limits of a child, from the size of the file. Real files take up to 13 s per megabyte (an assembly of 222
// solids) and less than a gigabyte; what takes several times as long is stuck.
constexpr double base_cpu_seconds = 30, cpu_seconds_per_megabyte = 60;
constexpr double most_cpu_seconds = 1800;
constexpr std::int64_t base_bytes = 4LL << 30, bytes_per_file_byte = 1000;

/// How a contained run ended, as far as it ended by itself.
enum class Outcome : std::uint8_t { done, cad_error, file_error };

void pack_options(const DomainOptions& options, Packer& packer) {
  packer.text(options.file);
  packer.value(std::uint8_t{options.transport.has_value()});
  packer.value(options.transport.value_or(cad::TransportDimensions{}));
  packer.value(options.kind);
  const cad::FarFieldOptions far_field = options.far_field.value_or(cad::FarFieldOptions{});
  packer.value(std::uint8_t{options.far_field.has_value()});
  packer.value(far_field.shape);
  packer.value(far_field.extent);
  packer.value(far_field.axis);
  packer.value(far_field.symmetry);
  packer.value(std::uint8_t{far_field.symmetry_position.has_value()});
  packer.value(far_field.symmetry_position.value_or(0));
  packer.value(options.trailing_edges.treatment);
  packer.value(static_cast<std::uint64_t>(options.trailing_edges.faces.size()));
  for (const std::string& pattern : options.trailing_edges.faces) packer.text(pattern);
  packer.value(options.trailing_edges.width);
  packer.value(options.smallest_size);
}

DomainOptions unpack_options(Unpacker& unpacker) {
  DomainOptions options;
  options.file = unpacker.text();
  const bool built_in = unpacker.value<std::uint8_t>() != 0;
  const auto transport = unpacker.value<cad::TransportDimensions>();
  if (built_in) options.transport = transport;
  options.kind = unpacker.value<cad::DomainKind>();
  const bool surrounded = unpacker.value<std::uint8_t>() != 0;
  cad::FarFieldOptions far_field;
  far_field.shape = unpacker.value<cad::FarFieldShape>();
  far_field.extent = unpacker.value<double>();
  far_field.axis = unpacker.value<cad::Axis>();
  far_field.symmetry = unpacker.value<cad::Symmetry>();
  const bool placed = unpacker.value<std::uint8_t>() != 0;
  const auto position = unpacker.value<double>();
  if (placed) far_field.symmetry_position = position;
  if (surrounded) options.far_field = far_field;
  options.trailing_edges.treatment = unpacker.value<cad::TrailingEdges>();
  options.trailing_edges.faces.resize(unpacker.value<std::uint64_t>());
  for (std::string& pattern : options.trailing_edges.faces) pattern = unpacker.text();
  options.trailing_edges.width = unpacker.value<double>();
  options.smallest_size = unpacker.value<double>();
  return options;
}

void pack_diagnosis(const cad::Diagnosis& diagnosis, Packer& packer) {
  packer.text(diagnosis.format);
  packer.text(diagnosis.unit_name);
  packer.value(diagnosis.bounds);
  packer.value(diagnosis.counts);
  pack_changes(diagnosis.findings, packer);
  packer.text(diagnosis.failure);
  packer.value(std::uint8_t{diagnosis.domain.has_value()});
  if (diagnosis.domain) pack_domain(*diagnosis.domain, packer);
}

cad::Diagnosis unpack_diagnosis(Unpacker& unpacker) {
  cad::Diagnosis diagnosis;
  diagnosis.format = unpacker.text();
  diagnosis.unit_name = unpacker.text();
  diagnosis.bounds = unpacker.value<geometry::Box>();
  diagnosis.counts = unpacker.value<cad::EntityCounts>();
  diagnosis.findings = unpack_changes(unpacker);
  diagnosis.failure = unpacker.text();
  if (unpacker.value<std::uint8_t>() != 0) diagnosis.domain = unpack_domain(unpacker);
  return diagnosis;
}

/// In the child: errors of known kinds travel as data, the step at hand goes to standard error.
template <class Work>
Bytes answer(std::span<const std::byte> input, Work work) {
  Unpacker unpacker(input);
  const auto sabotage = unpacker.value<Sabotage>();
  const DomainOptions options = unpack_options(unpacker);
  cad::listen_to_steps(
      [](const std::string& step) { fmt::print(stderr, "\n{}", step), std::fflush(stderr); });
  Packer packer;
  const auto fail = [&](Outcome outcome, const char* text) {
    packer = {};
    packer.value(outcome);
    packer.text(text);
  };
  try {
    parallel::commit_sabotage(sabotage);
    packer.value(Outcome::done);
    work(options, packer);
  } catch (const cad::CadError& error) {
    fail(Outcome::cad_error, error.what());
  } catch (const std::ios_base::failure& error) {
    fail(Outcome::file_error, error.what());
  }
  return packer.take();
}

Bytes prepare_task(std::span<const std::byte> input) {
  return answer(input, [](const DomainOptions& options, Packer& packer) {
    pack_domain(cad::prepare_domain(options), packer);
  });
}

Bytes diagnose_task(std::span<const std::byte> input) {
  return answer(input, [](const DomainOptions& options, Packer& packer) {
    pack_diagnosis(cad::diagnose(options), packer);
  });
}

void pack_named_faces(const std::vector<cad::NamedFaces>& list, Packer& packer) {
  packer.value(static_cast<std::uint64_t>(list.size()));
  for (const cad::NamedFaces& named : list) {
    packer.text(named.name);
    packer.value(named.faces);
  }
}

std::vector<cad::NamedFaces> unpack_named_faces(Unpacker& unpacker) {
  std::vector<cad::NamedFaces> list(unpacker.value<std::uint64_t>());
  for (cad::NamedFaces& named : list) {
    named.name = unpacker.text();
    named.faces = unpacker.value<std::int32_t>();
  }
  return list;
}

void pack_facts(const cad::CadFacts& facts, Packer& packer) {
  packer.text(facts.format);
  packer.text(facts.unit_name);
  packer.value(facts.unit_in_metres);
  packer.value(facts.bounds);
  for (const std::int32_t count : {facts.solids, facts.shells, facts.faces, facts.edges}) packer.value(count);
  for (const auto* list : {&facts.parts, &facts.face_names, &facts.layers, &facts.colours})
    pack_named_faces(*list, packer);
}

cad::CadFacts unpack_facts(Unpacker& unpacker) {
  cad::CadFacts facts;
  facts.format = unpacker.text();
  facts.unit_name = unpacker.text();
  facts.unit_in_metres = unpacker.value<double>();
  facts.bounds = unpacker.value<geometry::Box>();
  for (std::int32_t* count : {&facts.solids, &facts.shells, &facts.faces, &facts.edges})
    *count = unpacker.value<std::int32_t>();
  for (auto* list : {&facts.parts, &facts.face_names, &facts.layers, &facts.colours})
    *list = unpack_named_faces(unpacker);
  return facts;
}

Bytes look_task(std::span<const std::byte> input) {
  return answer(input, [](const DomainOptions& options, Packer& packer) {
    pack_facts(cad::look_at_cad_file(options.file), packer);
  });
}

double file_bytes(const DomainOptions& options) {
  std::error_code ignored;  // a file that is not there is reported by who reads it
  const auto size = options.file.empty() ? 0 : std::filesystem::file_size(options.file, ignored);
  return ignored ? 0 : double(size);
}

parallel::ContainedLimits limits_for(const DomainOptions& options) {
  const double bytes = file_bytes(options);
  parallel::ContainedLimits limits;
  limits.cpu_seconds = std::min(most_cpu_seconds, base_cpu_seconds + cpu_seconds_per_megabyte * bytes / 1e6);
  limits.address_space_bytes = base_bytes + bytes_per_file_byte * static_cast<std::int64_t>(bytes);
  return limits;
}

[[noreturn]] void throw_crash(const DomainOptions& options, const parallel::ContainedResult& result,
                              const parallel::ContainedLimits& limits) {
  const std::string source = options.transport ? "the built-in aircraft" : "'" + options.file + "'";
  std::string what = "failed";
  if (result.status == parallel::ContainedStatus::aborted) what = "crashed";
  if (result.status == parallel::ContainedStatus::out_of_time)
    what = fmt::format("took more than {:.0f} s", limits.cpu_seconds);
  if (result.status == parallel::ContainedStatus::out_of_memory) what = "ran out of memory";
  throw cad::CadError(
      fmt::format("{}: the CAD library {} while preparing this geometry ({}). Remedy: repair the file in the "
                  "CAD program, or "
                  "export it anew, in another format or part by part",
                  source, what, result.message));
}

/// Runs a task on the options and hands its output over where it ended well.
template <class Read>
auto run_task(const char* task, const DomainOptions& options, parallel::StageClock& clock, Sabotage sabotage,
              Read read) {
  Packer packer;
  packer.value(sabotage);
  pack_options(options, packer);
  const parallel::ContainedLimits limits = limits_for(options);
  const parallel::ContainedResult result = parallel::run_contained(task, packer.take(), limits);
  clock.add_task_cpu(result.cpu_seconds);
  clock.add_serial_cpu(result.cpu_seconds);
  clock.note_child_memory(result.peak_resident_bytes);
  if (result.status != parallel::ContainedStatus::ok) throw_crash(options, result, limits);
  Unpacker unpacker(result.output);
  const auto outcome = unpacker.value<Outcome>();
  // The CAD library takes memory that it does not get for faults of the geometry.
  if (outcome == Outcome::cad_error && result.short_of_memory) throw std::bad_alloc();
  if (outcome == Outcome::cad_error) throw cad::CadError(unpacker.text());
  if (outcome == Outcome::file_error) {
    std::string text = unpacker.text();
    const std::string suffix = ": " + std::make_error_code(std::io_errc::stream).message();
    if (text.ends_with(suffix)) text.resize(text.size() - suffix.size());  // it is appended once more here
    throw std::ios_base::failure(text);
  }
  return read(unpacker);
}

}  // namespace

void register_geometry_tasks() {
  parallel::register_contained_task(prepare_task_name, prepare_task);
  parallel::register_contained_task(diagnose_task_name, diagnose_task);
  parallel::register_contained_task(look_task_name, look_task);
}

cad::Domain prepare_contained(const DomainOptions& options, parallel::StageClock& clock, Sabotage sabotage) {
  return run_task(prepare_task_name, options, clock, sabotage, unpack_domain);
}

cad::Diagnosis diagnose_contained(const DomainOptions& options, parallel::StageClock& clock,
                                  Sabotage sabotage) {
  return run_task(diagnose_task_name, options, clock, sabotage, unpack_diagnosis);
}

cad::CadFacts look_contained(const std::string& file) {
  DomainOptions options;
  options.file = file;
  parallel::StageClock clock;
  return run_task(look_task_name, options, clock, Sabotage::none, unpack_facts);
}

cad::Model load_domain(const parallel::Communicator& communicator, const DomainOptions& options,
                       parallel::StageClock& clock, cad::DomainReport& report, Sabotage sabotage) {
  Bytes bytes;
  parallel::agree(communicator, [&] {
    if (!communicator.is_root()) return;
    cad::Domain domain = prepare_contained(options, clock, sabotage);
    const parallel::ScopedCpu cpu(clock, parallel::ScopedCpu::As::serial);
    report = std::move(domain.report);
    bytes = domain.model.serialise();
  });
  return share_model(communicator, std::move(bytes), clock);
}

cad::Model share_model(const parallel::Communicator& communicator, parallel::Bytes bytes,
                       parallel::StageClock& clock) {
  communicator.broadcast(bytes);
  std::optional<cad::Model> model;
  parallel::agree(communicator, [&] {
    const parallel::ScopedCpu cpu(clock, parallel::ScopedCpu::As::serial);
    model = cad::Model::from_bytes(bytes);
  });
  return *model;
}

}  // namespace aeroloom::pipeline
