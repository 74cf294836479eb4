#include "io/medit/medit_writer.hpp"

#include "io/medit/medit_layout.hpp"
#include "io/medit/medit_names.hpp"
#include "io/streams/range_writer.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/storage/shared_file.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <span>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

using mesh::GlobalIndex;
using mesh::LocalIndex;

/// Lines of a section on their way into the file.
class LineBuffer {
public:
  LineBuffer(parallel::SharedFile& file, const MeditLayout& layout) : _writer(file), _layout(layout) {}

  /// The lines that follow begin with this one.
  void begin_at(const MeditSection& section, GlobalIndex line) {
    _writer.move_to(section.lines + line * section.line_bytes);
  }
  void coordinate(double value) {
    if (binary()) return _writer.put(value);
    put_formatted("{:24.16e} ", value);
  }
  void integer(GlobalIndex value, bool last) {
    if (!binary()) return put_formatted("{:{}}{}", value, _layout.integer_width, last ? '\n' : ' ');
    if (_layout.version < 4) return _writer.put(static_cast<std::int32_t>(value));
    _writer.put(value);
  }
  /// Ends a line of coordinates: vertices have no reference.
  void no_reference() {
    if (binary()) return integer(0, true);
    _writer.put_text("0\n");
  }
  void text(std::int64_t offset, const std::string& bytes) {
    _writer.move_to(offset);
    _writer.put_text(bytes);
  }
  void flush() { _writer.flush(); }

private:
  bool binary() const { return _layout.encoding == MeditEncoding::binary; }
  template <class... Values>
  void put_formatted(fmt::format_string<Values...> format, Values... values) {
    _text.clear();
    fmt::format_to(std::back_inserter(_text), format, std::forward<Values>(values)...);
    _writer.put_text({_text.data(), _text.size()});
  }

  RangeWriter _writer;
  const MeditLayout& _layout;
  fmt::memory_buffer _text;  ///< of a number
};

MeditCounts medit_counts_of(const FileMesh& mesh) {
  const std::size_t references = std::max(mesh.regions.size(), mesh.patches.size());
  return {mesh.counts(CountedFaces::all), static_cast<GlobalIndex>(references)};
}

void write_vertices(const MeshPart& part, const MeditSection& section, LineBuffer& buffer) {
  buffer.begin_at(section, part.first_owned);
  for (LocalIndex v = 0; v < part.vertex_count(); ++v) {
    if (!part.owned[static_cast<std::size_t>(v)]) continue;
    const geometry::Vec3 p = part.point(v);
    buffer.coordinate(p.x), buffer.coordinate(p.y), buffer.coordinate(p.z);
    buffer.no_reference();
  }
}

void write_run(const MeshPart& part, const Block& block, const Run& run, LineBuffer& buffer) {
  for (LocalIndex i = run.begin; i < run.end; ++i) {
    const LocalIndex* corner = block.item(i);
    for (int k = 0; k < block.corners; ++k)
      buffer.integer(part.numbers[static_cast<std::size_t>(corner[k])] + 1, false);
    buffer.integer(GlobalIndex{run.id} + 1, true);
  }
}

/// Faces of one shape in patches of lower id, by patch.
std::vector<GlobalIndex> faces_before(const FileMesh& mesh, std::size_t shape) {
  std::vector<GlobalIndex> before;
  GlobalIndex sum = 0;
  for (const auto& of_patch : mesh.patch_faces) {
    before.push_back(sum);
    sum += of_patch[shape];
  }
  return before;
}

void write_faces(const FileMesh& mesh, std::size_t shape, const MeditSection& section, LineBuffer& buffer) {
  const std::vector<GlobalIndex> before = faces_before(mesh, shape);
  for (const MeshPart& part : mesh.parts) {
    for (const Run& run : part.faces[shape].runs) {
      buffer.begin_at(section, before[static_cast<std::size_t>(run.id)] + run.before);
      write_run(part, part.faces[shape], run, buffer);
    }
  }
}

void write_cells(const FileMesh& mesh, std::size_t shape, const MeditSection& section, LineBuffer& buffer) {
  for (const MeshPart& part : mesh.parts) {
    buffer.begin_at(section, part.cells[shape].before);
    for (const Run& run : part.cells[shape].runs) write_run(part, part.cells[shape], run, buffer);
  }
}

void write_medit_parts(const FileMesh& mesh, const MeditLayout& layout, bool is_root,
                       parallel::SharedFile& file) {
  LineBuffer buffer(file, layout);
  if (is_root) {
    buffer.text(0, layout.header);
    for (const MeditSection& section : layout.sections) buffer.text(section.begin, section.header);
    buffer.text(layout.footer_begin, layout.footer);
  }
  const MeditSection* const vertices = layout.find(MeditKeyword::vertices);
  for (const MeshPart& part : mesh.parts) write_vertices(part, *vertices, buffer);
  for (std::size_t s = 0; s < face_shape_count; ++s) {
    if (const MeditSection* const section = layout.find(medit_faces[s]))
      write_faces(mesh, s, *section, buffer);
  }
  for (std::size_t s = 0; s < cell_shape_count; ++s) {
    if (const MeditSection* const section = layout.find(medit_cells[s]))
      write_cells(mesh, s, *section, buffer);
  }
  buffer.flush();
}

}  // namespace

void write_medit(const FileMesh& mesh, const std::string& path, const MeditOptions& options) {
  const parallel::Communicator& communicator = mesh.communicator();
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension != ".meshb" && extension != ".mesh") {
    throw parallel::CollectiveError(parallel::FailureKind::input,
                                    fmt::format("'{}': Medit files end in .meshb or .mesh", path));
  }
  const MeditLayout layout =
      medit_layout(medit_counts_of(mesh), extension == ".mesh" ? MeditEncoding::text : MeditEncoding::binary,
                   options.wide);
  // Old mesh and new names must not stand beside each other.
  parallel::on_root(communicator, [&] { std::filesystem::remove(path); });
  parallel::write_shared_file(communicator, medit_names_path(path), [&](parallel::SharedFile& file) {
    if (!communicator.is_root()) return;
    const std::string names = medit_names_text(mesh);
    file.write(0, std::as_bytes(std::span(names.data(), names.size())));
  });
  parallel::write_shared_file(communicator, path, [&](parallel::SharedFile& file) {
    write_medit_parts(mesh, layout, communicator.is_root(), file);
  });
}

}  // namespace aeroloom::io
