#include "io/ugrid/ugrid_writer.hpp"

#include "io/boundary_patches.hpp"
#include "io/streams/range_writer.hpp"
#include "io/ugrid/ugrid_format.hpp"
#include "mesh/data/bounds.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/storage/shared_file.hpp"

#include <algorithm>
#include <filesystem>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

using mesh::GlobalIndex;
using mesh::LocalIndex;

/// Writes a mesh with integers of one width.
template <class Integer>
class UgridParts {
public:
  UgridParts(const FileMesh& mesh, const BoundaryPatches& patches, RangeWriter& writer)
      : _patches(patches),
        _counts(mesh.counts(CountedFaces::boundary)),
        _layout(ugrid_layout(_counts, sizeof(Integer))),
        _writer(writer) {}

  void write_counts() {
    _writer.move_to(0);
    for (const GlobalIndex count : in_ugrid_order(_counts)) _writer.put(static_cast<Integer>(count));
  }

  void write_part(const MeshPart& part) {
    write_points(part);
    for (std::size_t s = 0; s < face_shape_count; ++s) {
      for (const Run& run : part.faces[s].runs) {
        if (_patches.places[run.id] >= 0) write_faces(part, s, run);
      }
    }
    for (std::size_t s = 0; s < cell_shape_count; ++s) write_cells(part, s);
  }

private:
  static constexpr std::int64_t width = sizeof(Integer);

  void write_points(const MeshPart& part) {
    _writer.move_to(_layout.points + 24 * part.first_owned);
    for (LocalIndex v = 0; v < part.vertex_count(); ++v) {
      if (!part.owned[v]) continue;
      for (int k = 0; k < 3; ++k) _writer.put(part.coordinates[3 * static_cast<std::size_t>(v) + k]);
    }
  }

  void write_faces(const MeshPart& part, std::size_t shape, const Run& run) {
    const Block& block = part.faces[shape];
    const std::int32_t place = _patches.places[run.id];
    const GlobalIndex first = _patches.before[place][shape] + run.before;
    _writer.move_to(_layout.faces[shape] + first * block.corners * width);
    for (LocalIndex i = run.begin; i < run.end; ++i) {
      const LocalIndex* v = block.item(i);
      put_vertex(part, v[0]);
      for (int k = block.corners - 1; k > 0; --k) put_vertex(part, v[k]);
    }
    _writer.move_to(_layout.patch_ids[shape] + first * width);
    const Integer id = Integer{place} + Integer{1};
    for (LocalIndex i = run.begin; i < run.end; ++i) _writer.put(id);
  }

  void write_cells(const MeshPart& part, std::size_t shape) {
    const Block& block = part.cells[shape];
    if (block.count() == 0) return;
    _writer.move_to(_layout.cells[shape] + block.before * block.corners * width);
    for (LocalIndex i = 0; i < block.count(); ++i) {
      for (int k = 0; k < block.corners; ++k) put_vertex(part, block.item(i)[to_ugrid[shape][k]]);
    }
  }

  void put_vertex(const MeshPart& part, LocalIndex vertex) {
    _writer.put(static_cast<Integer>(part.numbers[vertex] + 1));
  }

  const BoundaryPatches& _patches;
  ShapeCounts _counts;
  UgridLayout _layout;
  RangeWriter& _writer;
};

template <class Integer>
void write_parts_of_rank(const FileMesh& mesh, const BoundaryPatches& patches, bool is_root,
                         RangeWriter& writer) {
  UgridParts<Integer> parts(mesh, patches, writer);
  if (is_root) parts.write_counts();
  for (const MeshPart& part : mesh.parts) parts.write_part(part);
  writer.flush();
}

/// The axis along which a patch has no extent to speak of: exact planes have none at all, and planes of
/// meshes read from other files what is left by their rounding.
NormalAxis normal_axis_of(const geometry::Box& box) {
  const geometry::Vec3 size = box.size();
  constexpr double no_extent = 1e-9;
  const double flat = no_extent * std::max({size.x, size.y, size.z});
  return size.x <= flat   ? NormalAxis::x
         : size.y <= flat ? NormalAxis::y
         : size.z <= flat ? NormalAxis::z
                          : NormalAxis::none;
}

/// The box around a patch. Collective.
geometry::Box box_of(const FileMesh& mesh, std::int32_t patch) {
  geometry::Box box;
  for (const MeshPart& part : mesh.parts) {
    for (const Block& block : part.faces) {
      for (const Run& run : block.runs) {
        if (run.id != patch) continue;
        for (LocalIndex i = run.begin; i < run.end; ++i) {
          for (int k = 0; k < block.corners; ++k) box.add(part.point(block.item(i)[k]));
        }
      }
    }
  }
  return mesh::box_over_ranks(mesh.communicator(), box);
}

/// Collective.
std::string mapbc_text(const FileMesh& mesh, const BoundaryPatches& patches) {
  const std::vector<std::string> names = names_in_mapbc(mesh, patches);
  std::string text = fmt::format("{}\n", patches.size());
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const mesh::PatchType type = mesh.patches[patches.ids[i]].type;
    const NormalAxis axis =
        type == mesh::PatchType::symmetry ? normal_axis_of(box_of(mesh, patches.ids[i])) : NormalAxis::none;
    text += fmt::format("{} {} {}\n", i + 1, mapbc_code_of(type, axis), names[i]);
  }
  return text;
}

}  // namespace

std::vector<std::string> names_in_mapbc(const FileMesh& mesh, const BoundaryPatches& patches) {
  std::vector<std::string> names;
  for (const std::int32_t id : patches.ids) names.push_back(mesh.patches[id].name);
  // List-directed reads of Fortran end a name at a comma, a semicolon or a slash, and take quotes and stars
  // for signs of their own.
  return plain_names(names, {.signs = "!#$%&()+-.:<=>?@[\\]^_`{|}~"});
}

void write_ugrid(const FileMesh& mesh, const std::string& path) {
  const parallel::Communicator& communicator = mesh.communicator();
  UgridKind kind;
  parallel::agree(communicator, [&] {
    kind = ugrid_kind_of(path);
    require_ugrid_fits(mesh.counts(CountedFaces::boundary), kind, path);
    // Conditions of an earlier mesh must not stand beside this one if it remains alone.
    if (communicator.is_root()) std::filesystem::remove(mapbc_path_of(path));
  });
  const BoundaryPatches patches = boundary_patches(mesh);
  parallel::write_shared_file(communicator, path, [&](parallel::SharedFile& file) {
    RangeWriter writer(file, kind.order);
    if (kind.integer_bytes == 4) {
      write_parts_of_rank<std::int32_t>(mesh, patches, communicator.is_root(), writer);
    } else {
      write_parts_of_rank<std::int64_t>(mesh, patches, communicator.is_root(), writer);
    }
  });
  const std::string text = mapbc_text(mesh, patches);
  parallel::write_shared_file(communicator, mapbc_path_of(path), [&](parallel::SharedFile& file) {
    if (communicator.is_root()) file.write_items(0, std::span<const char>(text));
  });
}

}  // namespace aeroloom::io
