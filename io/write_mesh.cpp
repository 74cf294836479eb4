#include "io/write_mesh.hpp"

#include "io/renamed_names.hpp"
#include "io/shared_path.hpp"
#include "io/staged_files.hpp"
#include "parallel/observation/log.hpp"

#include <algorithm>
#include <filesystem>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace aeroloom::io {

namespace {

namespace fs = std::filesystem;

/// Says what of the mesh the format has no place for.
void warn_of_losses(const FileMesh& mesh, const FormatContent& content, const std::string& file) {
  std::vector<std::string> between;
  for (std::size_t p = 0; !content.interfaces && p < mesh.patches.size(); ++p) {
    if (mesh.patches[p].type == mesh::PatchType::interior &&
        mesh.patch_faces[p][0] + mesh.patch_faces[p][1] > 0)
      between.push_back("'" + mesh.patches[p].name + "'");
  }
  const bool has_regions = !content.regions && mesh.regions.size() > 1;
  if (between.empty() && !has_regions) return;
  constexpr std::size_t shown = 5;
  const std::size_t all = between.size();
  between.resize(std::min(all, shown));
  std::string lost = has_regions ? fmt::format("its {} regions", mesh.regions.size()) : "";
  if (all > 0) {
    lost += fmt::format("{}{} patch(es) inside of the mesh: {}{}", has_regions ? " and " : "", all,
                        fmt::join(between, ", "), all > shown ? ", ..." : "");
  }
  parallel::log_warning(fmt::format(
      "'{}' has no place for {}: left out; msh, meshb, openfoam and vtkhdf keep {}", file, lost, "them"));
}

/// Solvers find patches by the names in the file.
void warn_of_names(const FileMesh& mesh, const FormatRow& row, const std::string& file) {
  if (row.renamed == nullptr) return;
  for (const RenamedName& each : row.renamed(mesh))
    parallel::log_warning(
        fmt::format("'{}' cannot hold the name '{}': it is '{}' there", file, each.name, each.in_file));
}

}  // namespace

void write_mesh(const FileMesh& mesh, FileFormat format, const std::string& path,
                const WriteOptions& options) {
  const FormatRow& row = row_of(format);
  const std::int32_t parts = options.parts > 0 ? options.parts : mesh.part_count;
  const bool cut = row.content.parts && (parts != mesh.part_count || (options.recut && parts > 1));
  if (cut) {
    WriteOptions as_they_are = options;
    as_they_are.recut = false;
    return write_mesh(repartition(mesh, parts), format, path, as_they_are);
  }
  const fs::path file = written_path(format, path);
  if (mesh.communicator().is_root()) {
    if (row.folder.empty()) warn_of_losses(mesh, row.content, file.filename().string());
    warn_of_names(mesh, row, file.filename().string());
  }
  if (!row.folder.empty()) return row.write(mesh, file.string(), options);
  write_together(mesh.communicator(), file.parent_path().string(), file.filename().string(),
                 [&](const std::string& staging) {
                   row.write(mesh, (fs::path(staging) / file.filename()).string(), options);
                 });
  if (row.remove_later_parts != nullptr)
    row.remove_later_parts({mesh.communicator(), file.string()}, mesh.part_count);
}

}  // namespace aeroloom::io
