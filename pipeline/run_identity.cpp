#include "pipeline/run_identity.hpp"

#include "aeroloom/parallel/communication/collective_error.hpp"
#include "report/library_versions.hpp"

#include <array>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace aeroloom::pipeline {
namespace {

/// The digest of a file; counts its bytes.
parallel::Digest digest_of_file(const std::string& path, std::int64_t* bytes = nullptr) {
  parallel::Digester digester;
  std::ifstream stream(path, std::ios::binary);
  constexpr std::size_t bytes_at_a_time = 1 << 20;
  std::vector<char> part(bytes_at_a_time);
  while (stream) {
    stream.read(part.data(), static_cast<std::streamsize>(part.size()));
    digester.bytes(
        std::as_bytes(std::span<const char>(part.data(), static_cast<std::size_t>(stream.gcount()))));
    if (bytes != nullptr) *bytes += stream.gcount();
  }
  return digester.result();
}

bool is_readable(const std::string& path) {
  std::error_code ignored;  // what cannot be looked at cannot be read
  return std::filesystem::is_regular_file(path, ignored) && std::ifstream(path).is_open();
}

}  // namespace

RunIdentity identify_run(const parallel::Communicator& communicator, const cases::Case& input) {
  RunIdentity identity;
  identity.version = "aeroloom " + report::program_version();
  for (const auto& [library, version] : report::library_versions())
    identity.version.append(", ").append(library).append(" ").append(version);
  std::vector<parallel::Digest> digests(2);
  std::vector<std::uint8_t> known{1};
  std::vector<std::int64_t> bytes{0};
  if (communicator.is_root()) {
    digests[0] = digest_of_file("/proc/self/exe");
    if (!input.domain.file.empty()) {
      known[0] = is_readable(input.domain.file) ? 1 : 0;
      if (known[0] != 0) digests[1] = digest_of_file(input.domain.file, &bytes[0]);
    }
  }
  communicator.broadcast_items(digests);
  communicator.broadcast_items(bytes);
  identity.bytes = bytes[0];
  communicator.broadcast_items(known);
  identity.is_known = known[0] != 0;
  identity.build = digests[0];
  if (input.domain.file.empty()) {
    cases::Case dimensions;
    dimensions.domain.transport = input.domain.transport;
    identity.input = "built-in aircraft";
    identity.digest = parallel::Digester().text(cases::resolved_yaml(dimensions)).result();
  } else {
    identity.input = std::filesystem::path(input.domain.file).filename().string();
    identity.digest = digests[1];
  }
  return identity;
}

void require_same_file(const parallel::Communicator& communicator, const RunIdentity& identity,
                       const cases::Case& input) {
  parallel::agree(communicator, [&] {
    if (!communicator.is_root() || input.domain.file.empty() || !identity.is_known) return;
    if (is_readable(input.domain.file) && digest_of_file(input.domain.file) == identity.digest) return;
    throw std::filesystem::filesystem_error("the file was changed while it was read", input.domain.file,
                                            std::make_error_code(std::errc::interrupted));
  });
}

}  // namespace aeroloom::pipeline
