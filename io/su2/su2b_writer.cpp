#include "io/boundary_patches.hpp"
#include "io/streams/range_writer.hpp"
#include "io/su2/su2_markers.hpp"
#include "io/su2/su2_writer.hpp"
#include "io/su2/su2b_layout.hpp"
#include "io/vtk_order.hpp"
#include "parallel/storage/shared_file.hpp"

#include <string>
#include <vector>

namespace aeroloom::io {

namespace {

using mesh::GlobalIndex;
using mesh::LocalIndex;

Su2bCounts counts_of_mesh(const FileMesh& mesh, const BoundaryPatches& patches) {
  Su2bCounts counts;
  counts.points = mesh.vertex_count;
  counts.cells = mesh.counts(CountedFaces::boundary).cells;
  for (const std::int32_t id : patches.ids) counts.markers.push_back(mesh.patch_faces[id]);
  return counts;
}

/// Writes a mesh with integers of one width.
template <class Integer>
class Su2bParts {
public:
  Su2bParts(const FileMesh& mesh, const BoundaryPatches& patches, RangeWriter& writer)
      : _patches(patches),
        _counts(counts_of_mesh(mesh, patches)),
        _layout(su2b_layout(_counts)),
        _writer(writer) {}

  /// All that stands between the sections of parts.
  void write_heads(const std::vector<std::string>& names) {
    _writer.move_to(0);
    _writer.put(static_cast<std::int32_t>(sizeof(Integer)));
    for (const std::int32_t value : {1, 1, 3}) _writer.put(value);  // zones, number of the zone, dimensions
    write_head(_layout.cells, su2b_start(_counts.cells, cell_shape_count));
    _writer.move_to(_layout.point_count);
    put(_counts.points);
    _writer.move_to(_layout.marker_count);
    _writer.put(static_cast<std::int32_t>(names.size()));
    for (std::size_t i = 0; i < names.size(); ++i) {
      std::string name = names[i];
      name.resize(su2b_name_bytes, '\0');
      _writer.move_to(_layout.names[i]);
      _writer.put_text(name);
      write_head(_layout.markers[i], su2b_start(_counts.markers[i], face_shape_count));
    }
  }

  void write_part(const MeshPart& part) {
    write_points(part);
    for (std::size_t s = 0; s < cell_shape_count; ++s) {
      const Block& block = part.cells[s];
      Items items{_layout.cells, su2b_start(_counts.cells, s), block.before, 0, block.count()};
      write_items(block, items, vtk_cell_type[s], [&](const LocalIndex* v, GlobalIndex number) {
        for (int k = 0; k < block.corners; ++k) put(part.numbers[v[to_vtk[s][k]]]);
        put(number);
      });
    }
    for (std::size_t s = 0; s < face_shape_count; ++s) {
      const Block& block = part.faces[s];
      for (const Run& run : block.runs) {
        const std::int32_t place = _patches.places[run.id];
        if (place < 0) continue;
        Items items{_layout.markers[place], su2b_start(_counts.markers[place], s), run.before, run.begin,
                    run.end};
        write_items(block, items, vtk_face_type[s], [&](const LocalIndex* v, GlobalIndex) {
          put(part.numbers[v[0]]);
          for (int k = block.corners - 1; k > 0; --k) put(part.numbers[v[k]]);
        });
      }
    }
  }

private:
  static constexpr std::int64_t width = sizeof(Integer);

  /// Elements of one shape: those from `begin` to `end` of a block, `before` of the same in front of them.
  struct Items {
    const Su2bLayout::Section& section;
    Su2bStart start;  ///< of the shape
    GlobalIndex before;
    LocalIndex begin, end;
  };

  void put(GlobalIndex value) { _writer.put(static_cast<Integer>(value)); }

  void write_head(const Su2bLayout::Section& section, const Su2bStart& end) {
    _writer.move_to(section.count);
    put(end.element);
    _writer.move_to(section.connectivity - width);
    put(end.integer);
  }

  void write_points(const MeshPart& part) {
    _writer.move_to(_layout.points + _layout.point_bytes() * part.first_owned);
    for (LocalIndex v = 0; v < part.vertex_count(); ++v) {
      if (!part.owned[v]) continue;
      for (int k = 0; k < 3; ++k) _writer.put(part.coordinates[3 * static_cast<std::size_t>(v) + k]);
      put(part.numbers[v]);
    }
  }

  /// `put_rest(corners, number)` puts what follows the type of an element, block.corners integers or one
  /// more.
  template <class PutRest>
  void write_items(const Block& block, const Items& items, std::uint8_t type, const PutRest& put_rest) {
    if (items.begin == items.end) return;
    const bool is_cells = &items.section == &_layout.cells;
    const std::int64_t integers = block.corners + (is_cells ? 2 : 1);
    const std::int64_t first = items.start.integer + items.before * integers;
    _writer.move_to(items.section.places + width * (items.start.element + items.before));
    for (LocalIndex i = items.begin; i < items.end; ++i) put(first + (i - items.begin) * integers);
    _writer.move_to(items.section.connectivity + width * first);
    for (LocalIndex i = items.begin; i < items.end; ++i) {
      put(type);
      put_rest(block.item(i), items.start.element + items.before + (i - items.begin));
    }
  }

  const BoundaryPatches& _patches;
  Su2bCounts _counts;
  Su2bLayout _layout;
  RangeWriter& _writer;
};

template <class Integer>
void write_su2b_parts(const FileMesh& mesh, const BoundaryPatches& patches,
                      const std::vector<std::string>& names, bool is_root, RangeWriter& writer) {
  Su2bParts<Integer> parts(mesh, patches, writer);
  if (is_root) parts.write_heads(names);
  for (const MeshPart& part : mesh.parts) parts.write_part(part);
  writer.flush();
}

}  // namespace

void write_su2b(const FileMesh& mesh, const std::string& path) {
  const BoundaryPatches patches = boundary_patches(mesh);
  const std::vector<std::string> names = marker_names(mesh, patches);
  const bool is_narrow = su2b_layout(counts_of_mesh(mesh, patches)).integer_bytes == 4;
  const bool is_root = mesh.communicator().is_root();
  remove_markers({mesh.communicator(), path});
  parallel::write_shared_file(mesh.communicator(), path, [&](parallel::SharedFile& file) {
    RangeWriter writer(file, ByteOrder::little);
    if (is_narrow) {
      write_su2b_parts<std::uint32_t>(mesh, patches, names, is_root, writer);
    } else {
      write_su2b_parts<std::uint64_t>(mesh, patches, names, is_root, writer);
    }
  });
  write_markers(path, mesh, patches, names);
}

}  // namespace aeroloom::io
