#include "pipeline/domain/load_domain.hpp"

#include "cad/model/step_trace.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/communication/packer.hpp"
#include "parallel/observation/timers.hpp"
#include "parallel/sandbox/crash_note.hpp"
#include "parallel/sandbox/fault.hpp"
#include "parallel/sandbox/sandbox.hpp"
#include "pipeline/case/option_keys.hpp"
#include "pipeline/domain/sandboxed_cad.hpp"

#include <cstdio>
#include <filesystem>
#include <ios>
#include <optional>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::domain {
namespace {

using cad::DomainOptions;
using parallel::Bytes;
using parallel::Fault;

// Limits of a child, from the size of the file. Real files take up to 13 s per megabyte (an assembly of 222
// solids) and less than a gigabyte; what takes several times as long is stuck.
constexpr double base_cpu_seconds = 30, cpu_seconds_per_megabyte = 60;
constexpr double most_cpu_seconds = 1800, bytes_per_megabyte = 1e6;
constexpr std::int64_t base_bytes = 4LL << 30, bytes_per_file_byte = 1000;

/// How a sandboxed run ended, as far as it ended by itself.
enum class Outcome : std::uint8_t { done, cad_error, file_error };

/// The answer of a child.
struct Answer {
  Outcome outcome = Outcome::done;
  std::string error;
  Bytes result;
};

/// All but the domain.
template <class Diagnosis>
auto findings_of(Diagnosis& diagnosis) {
  return std::tie(diagnosis.format, diagnosis.unit_name, diagnosis.bounds, diagnosis.counts,
                  diagnosis.findings, diagnosis.failure);
}

Bytes pack_diagnosis(const cad::Diagnosis& diagnosis) {
  const Bytes domain = diagnosis.domain ? pack_domain(*diagnosis.domain) : Bytes();
  return parallel::to_wire(std::forward_as_tuple(findings_of(diagnosis), domain));
}

cad::Diagnosis unpack_diagnosis(std::span<const std::byte> bytes) {
  cad::Diagnosis diagnosis;
  Bytes domain;
  auto all = std::tuple(findings_of(diagnosis), std::tie(domain));
  parallel::from_wire_into(bytes, all);
  if (!domain.empty()) diagnosis.domain = unpack_domain(domain);
  return diagnosis;
}

/// The step at hand, for the message about a crash: a child prints it to standard error.
void note_step(const std::string& step) {
  if (!parallel::is_sandbox_child()) return parallel::set_crash_note("stage geometry, " + step);
  fmt::print(stderr, "\n{}", step);
  std::fflush(stderr);
}

/// In the child: errors of known kinds travel as data.
template <class Work>
Bytes answer(std::span<const std::byte> input, Work work) {
  const auto [fault, options] = parallel::from_wire<std::tuple<Fault, DomainOptions>>(input);
  cad::listen_to_steps(note_step);
  Answer answer;
  try {
    parallel::inject_fault(fault);
    answer.result = work(options);
  } catch (const cad::CadError& error) {
    answer = {Outcome::cad_error, error.what(), {}};
  } catch (const std::ios_base::failure& error) {
    answer = {Outcome::file_error, error.what(), {}};
  }
  return parallel::hand_over_to_wire(std::move(answer));
}

Bytes prepare_domain(std::span<const std::byte> input) {
  return answer(input,
                [](const DomainOptions& options) { return pack_domain(cad::prepare_domain(options)); });
}

Bytes diagnose_domain(std::span<const std::byte> input) {
  return answer(input, [](const DomainOptions& options) { return pack_diagnosis(cad::diagnose(options)); });
}

Bytes look_at_file(std::span<const std::byte> input) {
  return answer(input, [](const DomainOptions& options) {
    return parallel::to_wire(cad::look_at_cad_file(options.file, options.encoding));
  });
}

const parallel::NamedTask prepare_task("geometry.prepare", prepare_domain);
const parallel::NamedTask diagnose_task("geometry.diagnose", diagnose_domain);
const parallel::NamedTask look_task("geometry.look", look_at_file);

double file_bytes(const DomainOptions& options) {
  double sum = 0;
  const auto add = [&](const std::string& file) {
    std::error_code ignored;  // a file that is not there is reported by who reads it
    const auto size = file.empty() ? 0 : std::filesystem::file_size(file, ignored);
    if (!ignored) sum += double(size);
  };
  add(options.file);
  for (const cad::FacetedBody& part : options.parts) add(part.file);
  return sum;
}

parallel::SandboxLimits limits_for(const DomainOptions& options) {
  const double bytes = file_bytes(options);
  parallel::SandboxLimits limits;
  limits.cpu_seconds =
      std::min(most_cpu_seconds, base_cpu_seconds + cpu_seconds_per_megabyte * bytes / bytes_per_megabyte);
  // Bodies that overlap parts become triangles, as many as sizes ask for, whatever the size of files.
  if (!options.parts.empty()) limits.cpu_seconds = most_cpu_seconds;
  limits.address_space_bytes = base_bytes + bytes_per_file_byte * static_cast<std::int64_t>(bytes);
  return limits;
}

std::string source_of(const DomainOptions& options) {
  return options.transport ? "the built-in aircraft" : "'" + options.file + "'";
}

[[noreturn]] void throw_crash(const DomainOptions& options, const parallel::SandboxResult& result,
                              const parallel::SandboxLimits& limits) {
  std::string what = "failed";
  if (result.status == parallel::SandboxStatus::aborted) what = "crashed";
  if (result.status == parallel::SandboxStatus::out_of_time)
    what = fmt::format("took more than {:.0f} s", limits.cpu_seconds);
  if (result.status == parallel::SandboxStatus::out_of_memory) what = "ran out of memory";
  throw cad::CadError(
      fmt::format("{}: the CAD library {} while preparing this geometry ({}). Remedy: repair the file in the "
                  "CAD program, or "
                  "export it anew, in another format or part by part",
                  source_of(options), what, result.message));
}

/// Runs a task on the options; its result where it ended well.
Bytes run_task(const parallel::NamedTask& task, const DomainOptions& options, Fault fault) {
  const parallel::SandboxLimits limits = limits_for(options);
  const parallel::CrashNote note(fmt::format("stage geometry, {}", source_of(options)));
  const parallel::SandboxResult result =
      parallel::run_sandboxed(task.name(), parallel::to_wire(std::tie(fault, options)), limits);
  parallel::add_task_cpu(result.cpu_seconds);
  parallel::add_serial_cpu(result.cpu_seconds);
  parallel::note_child_memory(result.peak_resident_bytes);
  if (result.status != parallel::SandboxStatus::ok) throw_crash(options, result, limits);
  auto answer = parallel::from_wire<Answer>(result.output);
  // The CAD library takes memory that it does not get for faults of the geometry.
  if (answer.outcome == Outcome::cad_error && result.short_of_memory) throw std::bad_alloc();
  if (answer.outcome == Outcome::cad_error) throw cad::CadError(answer.error);
  if (answer.outcome == Outcome::file_error) {
    std::string text = answer.error;
    const std::string suffix = ": " + std::make_error_code(std::io_errc::stream).message();
    if (text.ends_with(suffix)) text.resize(text.size() - suffix.size());  // it is appended once more here
    throw std::ios_base::failure(text);
  }
  return std::move(answer.result);
}

}  // namespace

Bytes pack_domain(const cad::Domain& domain) {
  return parallel::to_wire(std::forward_as_tuple(domain.report, domain.model.serialise()));
}

cad::Domain unpack_domain(std::span<const std::byte> bytes) {
  auto [report, model] = parallel::from_wire<std::tuple<cad::DomainReport, Bytes>>(bytes);
  for (cad::Change& change : report.changes) change.what = cases::with_keys(std::move(change.what));
  return {cad::Model::from_bytes(model), std::move(report)};
}

cad::Domain prepare_sandboxed(const DomainOptions& options) {
  return unpack_domain(run_task(prepare_task, options, parallel::requested_fault("domain").fault));
}

cad::Diagnosis diagnose_sandboxed(const DomainOptions& options) {
  return unpack_diagnosis(run_task(diagnose_task, options, parallel::requested_fault("domain").fault));
}

cad::CadFacts look_sandboxed(const std::string& file, const std::string& encoding) {
  DomainOptions options;
  options.file = file, options.encoding = encoding;
  return parallel::from_wire<cad::CadFacts>(run_task(look_task, options, Fault::none));
}

cad::Domain load_domain(const parallel::Communicator& communicator, const DomainOptions& options) {
  cad::DomainReport report;
  Bytes bytes;
  parallel::on_root(communicator, [&] {
    cad::Domain domain = prepare_sandboxed(options);
    const parallel::ScopedCpu cpu(parallel::ScopedCpu::As::serial);
    report = std::move(domain.report);
    bytes = domain.model.serialise();
  });
  return {broadcast_model(communicator, std::move(bytes)), std::move(report)};
}

cad::Model broadcast_model(const parallel::Communicator& communicator, parallel::Bytes bytes) {
  communicator.broadcast(bytes);
  std::optional<cad::Model> model;
  parallel::collectively(communicator, parallel::ScopedCpu::As::repeated,
                         [&] { model = cad::Model::from_bytes(bytes); });
  return *model;
}

}  // namespace aeroloom::domain
