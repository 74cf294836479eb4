#include "pipeline/run_identity.hpp"

#include "pipeline/library_versions.hpp"

#include <array>
#include <filesystem>
#include <fstream>

namespace aeroloom::pipeline {
namespace {

parallel::Digest digest_of_file(const std::string& path) {
  parallel::Digester digester;
  std::ifstream stream(path, std::ios::binary);
  std::vector<char> part(1 << 20);
  while (stream) {
    stream.read(part.data(), static_cast<std::streamsize>(part.size()));
    digester.bytes(
        std::as_bytes(std::span<const char>(part.data(), static_cast<std::size_t>(stream.gcount()))));
  }
  return digester.result();
}

bool is_readable(const std::string& path) {
  std::error_code ignored;  // what cannot be looked at cannot be read
  return std::filesystem::is_regular_file(path, ignored) && std::ifstream(path).is_open();
}

}  // namespace

RunIdentity identify_run(const parallel::Communicator& communicator, const Case& input) {
  RunIdentity identity;
  identity.version = "aeroloom " + program_version();
  for (const auto& [library, version] : library_versions())
    identity.version.append(", ").append(library).append(" ").append(version);
  std::vector<parallel::Digest> digests(2);
  std::vector<std::uint8_t> known{1};
  if (communicator.is_root()) {
    digests[0] = digest_of_file("/proc/self/exe");
    if (!input.domain.file.empty()) {
      known[0] = is_readable(input.domain.file) ? 1 : 0;
      digests[1] = digest_of_file(input.domain.file);
    }
  }
  communicator.broadcast_items(digests);
  communicator.broadcast_items(known);
  identity.is_known = known[0] != 0;
  identity.build = digests[0];
  if (input.domain.file.empty()) {
    Case dimensions;
    dimensions.domain.transport = input.domain.transport;
    identity.input = "built-in aircraft";
    identity.digest = parallel::Digester().text(resolved_yaml(dimensions)).result();
  } else {
    identity.input = std::filesystem::path(input.domain.file).filename().string();
    identity.digest = digests[1];
  }
  return identity;
}

}  // namespace aeroloom::pipeline
