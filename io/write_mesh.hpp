/// Writes a mesh in any format.
#pragma once

#include "io/file_formats.hpp"
#include "io/file_mesh.hpp"

#include <cstdint>
#include <string>

namespace aeroloom::io {

struct WriteOptions {
  std::int32_t parts = 0;                       ///< for formats with parts; 0: the parts of the mesh
  Compression compression = Compression::none;  ///< for .vtu and .vtp
  /// Repartitions even if the mesh has this number of parts. The parts of assemble() need it: they are ranges
  /// of the file's cells, not compact, and own vertices that they do not use.
  bool recut = false;
  /// Writes NAME_surface.pvtp beside NAME.pvtu, and NAME_interfaces.pvtp if there are faces between regions.
  /// NAME.vtkhdf always has its surface.
  bool surface = false;
};

/// Writes a mesh to written_path(format, path). Companions (`.mapbc`, folders with data files, surfaces for
/// viewers) take their names from it. All appear together or not at all (write_together); of OpenFOAM the
/// mesh does. For formats with parts, repartition() cuts the mesh if it has another number of parts than
/// asked for. The mesh is never gathered; files depend on the parts, not on ranks. Collective. Throws
/// CollectiveError: (files) where a file cannot be written, (input) where the format cannot hold the mesh.
void write_mesh(const FileMesh& mesh, FileFormat format, const std::string& path,
                const WriteOptions& options);

}  // namespace aeroloom::io
