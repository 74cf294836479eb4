#include "pipeline/run_identity.hpp"

#include "cad/read/input_files.hpp"
#include "parallel/communication/collective_error.hpp"
#include "pipeline/report/library_versions.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <vector>

#include <fmt/format.h>

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

/// Of one file its own digest, of several that of theirs.
parallel::Digest digest_of_files(const std::vector<std::string>& files, std::int64_t* bytes = nullptr) {
  if (files.size() == 1) return digest_of_file(files.front(), bytes);
  parallel::Digester digester;
  for (const std::string& file : files) digester.text(digest_of_file(file, bytes).text());
  return digester.result();
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
    const std::vector<std::string> files = cad::input_files_of(input.domain);
    known[0] = std::all_of(files.begin(), files.end(), is_readable) ? 1 : 0;
    if (known[0] != 0 && !files.empty()) digests[1] = digest_of_files(files, &bytes[0]);
  }
  communicator.broadcast_items(digests);
  communicator.broadcast_items(bytes);
  identity.bytes = bytes[0];
  communicator.broadcast_items(known);
  identity.is_known = known[0] != 0;
  identity.build = digests[0];
  identity.files = digests[1];
  if (input.domain.file.empty()) {
    cases::Case dimensions;
    dimensions.domain.transport = input.domain.transport;
    identity.input = "built-in aircraft";
    parallel::Digester digester;
    digester.text(cases::resolved_yaml(dimensions));
    if (!input.domain.parts.empty()) digester.text(digests[1].text());
    identity.digest = digester.result();
  } else {
    identity.input = std::filesystem::path(input.domain.file).filename().string();
    identity.digest = digests[1];
  }
  return identity;
}

void require_same_file(const RunIdentity& identity, const cases::Case& input) {
  const std::vector<std::string> files = cad::input_files_of(input.domain);
  if (files.empty() || !identity.is_known) return;
  if (std::all_of(files.begin(), files.end(), is_readable) && digest_of_files(files) == identity.files)
    return;
  const char* const what =
      files.size() == 1 ? "the file was changed while it was read" : "a file was changed while it was read";
  throw std::filesystem::filesystem_error(what, files.front(), std::make_error_code(std::errc::interrupted));
}

std::string text_of_files(const RunIdentity& identity, const cases::Case& input) {
  const cad::DomainOptions& domain = input.domain;
  if (domain.file.empty() || !identity.is_known) return {};
  const std::string parts = domain.parts.empty() ? "" : fmt::format(" and {} parts", domain.parts.size());
  return fmt::format("'{}'{}, {} bytes, hash {}", domain.file, parts, identity.bytes, identity.digest.text());
}

}  // namespace aeroloom::pipeline
