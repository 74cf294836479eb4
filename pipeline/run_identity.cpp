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

}  // namespace

RunIdentity identify_run(const parallel::Communicator& communicator, const Case& input) {
  RunIdentity identity;
  identity.version = "aeroloom " + program_version();
  for (const auto& [library, version] : library_versions())
    identity.version.append(", ").append(library).append(" ").append(version);
  std::vector<parallel::Digest> digests(2);
  if (communicator.is_root()) {
    digests[0] = digest_of_file("/proc/self/exe");
    if (!input.domain.file.empty()) digests[1] = digest_of_file(input.domain.file);
  }
  communicator.broadcast_items(digests);
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
