#include "pipeline/info_file.hpp"

#include "io/file_formats.hpp"
#include "io/read_mesh.hpp"
#include "mesh/data/bounds.hpp"
#include "parallel/communication/collective_error.hpp"
#include "pipeline/case/case.hpp"
#include "pipeline/domain/sandboxed_cad.hpp"
#include "pipeline/info_text.hpp"
#include "pipeline/report/text_file.hpp"

#include <cstdio>
#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace aeroloom::pipeline {
namespace {

using Json = nlohmann::ordered_json;

constexpr int info_schema_version = 1;

geometry::Box bounds_of(const io::FileMesh& mesh) {
  geometry::Box box;
  for (const io::MeshPart& part : mesh.parts) {
    for (mesh::LocalIndex v = 0; v < part.vertex_count(); ++v) box.add(part.point(v));
  }
  return mesh::box_over_ranks(mesh.pieces->communicator, box);
}

/// Letters of names that are no UTF-8 are replaced.
void show(const InfoRequest& request, const Json& facts, const std::string& text) {
  std::error_code ignored;  // the size is printed where there is one
  const std::uintmax_t bytes = std::filesystem::file_size(request.file, ignored);
  if (request.print_json) {
    Json json = {{"schema_version", info_schema_version}, {"file", request.file}};
    json["bytes"] = ignored ? Json() : Json(bytes);
    json.update(facts);
    report::print_text(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  } else {
    report::print_text(
        fmt::format("'{}'{}: {}", request.file, ignored ? "" : fmt::format(", {} bytes", bytes), text));
  }
}

/// Collective.
void show_mesh(const io::Assembled& file, const InfoRequest& request) {
  const parallel::Communicator& communicator = file.mesh.pieces->communicator;
  const io::ReadableFile format = io::readable_file(request.file);
  MeshFileFacts facts{std::string(format.end->description), 0, bounds_of(file.mesh),
                      io::find_doubled_nodes(file.mesh)};
  if (communicator.is_root() && format.row->named_parts != nullptr)
    facts.parts = format.row->named_parts(request.file);
  parallel::agree(communicator, [&] {
    if (communicator.is_root()) show(request, info_json(file, facts), info_text(file, facts));
  });
}

void show_case(const InfoRequest& request) {
  const std::string resolved = cases::resolved_yaml(cases::read_case(request.file, {}));
  show(request, {{"kind", "case"}, {"configuration", resolved}},
       "a case; with every value spelled out:\n" + resolved + "\n");
}

void show_cad(const InfoRequest& request) {
  const cad::CadFacts facts = domain::look_sandboxed(request.file, request.encoding);
  show(request, info_json(facts), info_text(facts));
}

/// Refuses early, with one message, what is not a file.
void require_file(const std::string& file) {
  if (file.find('*') != std::string::npos) return;
  std::error_code code;
  const auto status = std::filesystem::status(file, code);
  if (!std::filesystem::exists(status))
    throw std::filesystem::filesystem_error("cannot read", file,
                                            std::make_error_code(std::errc::no_such_file_or_directory));
  if (std::filesystem::is_directory(status))
    throw std::runtime_error(fmt::format(
        "'{}' is a folder; give a file: a mesh ({}), CAD (STEP, IGES, BREP), triangles (STL, OBJ, OFF, "
        "PLY, .poly, .smesh) or a case (.yaml)",
        file, fmt::join(io::readable_extensions(), ", ")));
}

}  // namespace

void show_info(const parallel::Communicator& communicator, const InfoRequest& request) {
  parallel::on_root(communicator, [&] { require_file(request.file); });
  if (io::readable_file(request.file).row != nullptr)
    return show_mesh(io::read_mesh({communicator, request.file}, 0), request);
  if (request.file.ends_with(".yaml") || request.file.ends_with(".yml"))
    return parallel::on_root(communicator, [&] { show_case(request); });
  const std::optional<io::FileFormat> written = io::format_of_path(request.file);
  if (written) {
    throw parallel::CollectiveError(
        parallel::FailureKind::files,
        fmt::format("'{}': {} is written here, but not read; meshes that are read end like {}", request.file,
                    io::name_of(*written), fmt::join(io::readable_extensions(), ", ")));
  }
  parallel::on_root(communicator, [&] { show_cad(request); });
}

}  // namespace aeroloom::pipeline
