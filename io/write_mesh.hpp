/// Writing a mesh, whatever its format.
#pragma once

#include "io/file_formats.hpp"
#include "io/file_mesh.hpp"
#include "io/vtk/vtk_writer.hpp"

#include <cstdint>
#include <string>

namespace aeroloom::io {

struct WriteOptions {
  std::int32_t parts = 0;                       ///< of formats that come in parts; 0: those of the mesh
  Compression compression = Compression::none;  ///< of .vtu and .vtp
  /// Parts are cut anew even where the mesh has as many: those of assemble() are runs of the file's cells,
  /// which may lie anywhere, and own vertices that they do not use.
  bool recut = false;
  /// Beside NAME.pvtu the boundary as NAME_surface.pvtp, and faces between regions, where there are some, as
  /// NAME_interfaces.pvtp. NAME.vtkhdf has its surface always.
  bool surface = false;
};

/// Writes a mesh to written_path(format, path); what lies beside it (`.mapbc`, folders of
/// parts, surfaces for viewers) takes its name from there, and appears together with it or not at all
/// (write_together; OpenFOAM: its mesh does). Formats in parts get as many as asked for, cut anew by
/// repartition() where the mesh has others. Never gathers; the files depend on the parts, not on ranks.
/// Collective; throws CollectiveError (files) where something cannot be written, (input) where the format
/// cannot hold the mesh.
void write_mesh(const FileMesh& mesh, FileFormat format, const std::string& path,
                const WriteOptions& options);

}  // namespace aeroloom::io
