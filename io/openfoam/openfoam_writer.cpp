#include "io/openfoam/openfoam_writer.hpp"

#include "io/openfoam/foam_case.hpp"
#include "io/openfoam/foam_faces.hpp"
#include "io/openfoam/foam_file.hpp"
#include "io/openfoam/sharp_edges.hpp"
#include "parallel/communication/collective_error.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <system_error>

#include <fmt/format.h>

namespace aeroloom::io {

namespace fs = std::filesystem;

namespace {

using mesh::GlobalIndex;
using mesh::LocalIndex;

struct Names {
  FoamPatches patches;
  std::vector<std::string> regions;
};

/// What the files of all parts go by.
struct FoamMesh {
  const FileMesh& mesh;
  const FoamPlan& plan;
  Names names;
  FoamFormat format;
};

const char* foam_type_of(mesh::PatchType type) {
  switch (type) {
    case mesh::PatchType::wall:
      return "wall";
    case mesh::PatchType::symmetry:
      return "symmetry";
    default:
      return "patch";
  }
}

bool is_boundary(const mesh::Patch& patch) {
  return patch.type != mesh::PatchType::interior;
}

/// Writes the files of one part.
class FoamPartWriter {
public:
  FoamPartWriter(const FoamMesh& whole, const MeshPart& part, const FoamFaces& order, fs::path folder)
      : _mesh(whole.mesh),
        _part(part),
        _plan(whole.plan),
        _order(order),
        _names(whole.names),
        _format(whole.format),
        _folder(std::move(folder)) {}

  void write() {
    fs::create_directories(_folder);
    write_points();
    write_faces();
    write_cells_of_faces();
    write_boundary();
    if (_mesh.regions.size() > 1) write_cell_zones();
    if (!std::all_of(_mesh.patches.begin(), _mesh.patches.end(), is_boundary)) write_face_zones();
    if (_mesh.part_count > 1) write_addressing();
  }

private:
  LocalFile open(const char* kind, const char* object, std::string_view note = {}) const {
    LocalFile file((_folder / object).string());
    file.text(foam_header(_format, kind, "constant/polyMesh", object, note));
    return file;
  }
  /// A file that is one list of labels: label(0), label(1), ...
  template <class Label>
  void write_labels(const char* object, std::size_t count, const Label& label, std::string_view note = {}) {
    LocalFile file = open("labelList", object, note);
    FoamList list(file, _format, static_cast<std::int64_t>(count));
    for (std::size_t i = 0; i < count; ++i) list.label(label(i));
    list.end();
    file.text("\n");
    file.finish();
  }
  std::span<const FoamFace> faces() const { return _order.faces; }

  void write_points() {
    LocalFile file = open("vectorField", "points");
    FoamList list(file, _format, _part.vertex_count());
    for (LocalIndex v = 0; v < _part.vertex_count(); ++v)
      list.vector(_part.coordinates.data() + 3 * static_cast<std::size_t>(v));
    list.end();
    file.text("\n");
    file.finish();
  }

  void write_faces() {
    LocalFile file = open(_format.binary ? "faceCompactList" : "faceList", "faces");
    if (_format.binary) {
      write_compact(file);
    } else {
      file.text(fmt::format("{}\n(\n", faces().size()));
      for (const FoamFace& face : faces()) {
        const FoamCorners c = corners_of_face(_part, face);
        std::string text = fmt::format("{}({} {} {}", c.count, c.corners[0], c.corners[1], c.corners[2]);
        if (c.count == 4) text += fmt::format(" {}", c.corners[3]);
        file.text(text + ")\n");
      }
      file.text(")\n");
    }
    file.finish();
  }

  /// Where each face begins, then corners.
  void write_compact(LocalFile& file) {
    FoamList begins(file, _format, static_cast<std::int64_t>(faces().size()) + 1);
    std::int64_t begin = 0;
    begins.label(begin);
    for (const FoamFace& face : faces()) {
      begin += corners_of_face(_part, face).count;
      begins.label(begin);
    }
    begins.end();
    file.text("\n");
    FoamList corners(file, _format, begin);
    for (const FoamFace& face : faces()) {
      const FoamCorners c = corners_of_face(_part, face);
      for (int k = 0; k < c.count; ++k) corners.label(c.corners[static_cast<std::size_t>(k)]);
    }
    corners.end();
    file.text("\n");
  }

  void write_cells_of_faces() {
    const std::string note =
        fmt::format("nPoints:{} nCells:{} nFaces:{} nInternalFaces:{}", _part.vertex_count(),
                    _part.cell_count(), faces().size(), _order.inner);
    write_labels(
        "owner", faces().size(), [&](std::size_t f) { return faces()[f].cell; }, note);
    write_labels(
        "neighbour", static_cast<std::size_t>(_order.inner),
        [&](std::size_t f) { return faces()[f].neighbour; }, note);
  }

  void write_boundary() {
    LocalFile file((_folder / "boundary").string());
    const FoamFormat text{false, _format.label_bits};
    file.text(foam_header(text, "polyBoundaryMesh", "constant/polyMesh", "boundary"));
    const auto patches = std::count_if(_mesh.patches.begin(), _mesh.patches.end(), is_boundary);
    file.text(fmt::format("{}\n(\n", static_cast<std::size_t>(patches) + _order.processors.size()));
    std::int64_t start = _order.inner;
    for (std::size_t p = 0; p < _mesh.patches.size(); ++p) {
      if (!is_boundary(_mesh.patches[p])) continue;
      file.text(fmt::format("    {}\n    {{\n        type            {};\n", _names.patches.names[p],
                            foam_type_of(_mesh.patches[p].type)));
      if (!_names.patches.groups[p].empty())
        file.text(fmt::format("        inGroups        1({});\n", _names.patches.groups[p]));
      file.text(fmt::format("        nFaces          {};\n        startFace       {};\n    }}\n",
                            _order.of_patch[p], start));
      start += _order.of_patch[p];
    }
    for (const FoamProcessorPatch& patch : _order.processors) {
      file.text(
          fmt::format("    procBoundary{0}to{1}\n    {{\n        type            processor;\n"
                      "        inGroups        1(processor);\n        nFaces          {2};\n"
                      "        startFace       {3};\n        matchTolerance  0.0001;\n"
                      "        transform       unknown;\n        myProcNo        {0};\n"
                      "        neighbProcNo    {1};\n    }}\n",
                      _part.id, patch.other, patch.count, start));
      start += patch.count;
    }
    file.text(")\n");
    file.finish();
  }

  void write_cell_zones() {
    LocalFile file = open("regIOobject", "cellZones");
    file.text(fmt::format("{}\n(\n", _mesh.regions.size()));
    for (std::size_t region = 0; region < _mesh.regions.size(); ++region) {
      std::vector<std::pair<LocalIndex, LocalIndex>> ranges;
      std::int64_t count = 0;
      LocalIndex first = 0;
      for (const Block& block : _part.cells) {
        for (const Run& run : block.runs) {
          if (run.id != static_cast<std::int32_t>(region)) continue;
          ranges.emplace_back(first + run.begin, first + run.end);
          count += run.end - run.begin;
        }
        first += block.count();
      }
      file.text(
          fmt::format("{}\n{{\n    type cellZone;\n    cellLabels List<label> ", _names.regions[region]));
      FoamList list(file, _format, count);
      for (const auto& [begin, end] : ranges) {
        for (LocalIndex cell = begin; cell < end; ++cell) list.label(cell);
      }
      list.end();
      file.text(";\n}\n");
    }
    file.text(")\n");
    file.finish();
  }

  void write_face_zones() {
    LocalFile file = open("regIOobject", "faceZones");
    const auto inner = _mesh.patches.size() - static_cast<std::size_t>(std::count_if(
                                                  _mesh.patches.begin(), _mesh.patches.end(), is_boundary));
    std::vector<std::vector<LocalIndex>> zones(_mesh.patches.size());
    for (std::size_t f = 0; f < faces().size(); ++f) {
      if (faces()[f].zone >= 0) zones[faces()[f].zone].push_back(static_cast<LocalIndex>(f));
    }
    file.text(fmt::format("{}\n(\n", inner));
    for (std::size_t p = 0; p < zones.size(); ++p) {
      if (is_boundary(_mesh.patches[p])) continue;
      file.text(
          fmt::format("{}\n{{\n    type faceZone;\n    faceLabels List<label> ", _names.patches.names[p]));
      const auto count = static_cast<std::int64_t>(zones[p].size());
      FoamList labels(file, _format, count);
      for (const LocalIndex f : zones[p]) labels.label(f);
      labels.end();
      file.text(";\n    flipMap List<bool> ");
      FoamList flips(file, _format, count);
      for (const LocalIndex f : zones[p]) flips.flag(faces()[f].from_front == 0);
      flips.end();
      file.text(";\n}\n");
    }
    file.text(")\n");
    file.finish();
  }

  void write_addressing() {
    const GlobalIndex first = _plan.first_cell[static_cast<std::size_t>(_part.id)];
    write_labels("cellProcAddressing", static_cast<std::size_t>(_part.cell_count()),
                 [&](std::size_t cell) { return first + static_cast<GlobalIndex>(cell); });
    write_labels("faceProcAddressing", faces().size(), [&](std::size_t f) {
      return faces()[f].flipped != 0 ? -(faces()[f].number + 1) : faces()[f].number + 1;
    });
    write_labels("pointProcAddressing", _part.numbers.size(),
                 [&](std::size_t v) { return _part.numbers[v]; });
    std::vector<std::int64_t> patches;
    for (const mesh::Patch& patch : _mesh.patches) {
      if (is_boundary(patch)) patches.push_back(static_cast<std::int64_t>(patches.size()));
    }
    patches.resize(patches.size() + _order.processors.size(), -1);
    write_labels("boundaryProcAddressing", patches.size(), [&](std::size_t p) { return patches[p]; });
  }

  const FileMesh& _mesh;
  const MeshPart& _part;
  const FoamPlan& _plan;
  const FoamFaces& _order;
  const Names& _names;
  FoamFormat _format;
  fs::path _folder;
};

FoamFormat format_of(const FileMesh& mesh, const FoamPlan& plan, const OpenFoamOptions& options) {
  GlobalIndex corners = 0;
  for (const MeshPart& part : mesh.parts) {
    corners = std::max<GlobalIndex>(
        corners, 12 * GlobalIndex{part.cells[0].count()} + 16 * GlobalIndex{part.cells[1].count()} +
                     18 * GlobalIndex{part.cells[2].count()} + 24 * GlobalIndex{part.cells[3].count()});
  }
  corners = mesh.communicator().maximum(corners);
  FoamFormat format;
  format.binary = options.binary;
  format.label_bits = options.label_bits != 0
                          ? options.label_bits
                          : foam_label_bits(plan.cells, plan.faces, mesh.vertex_count, corners);
  return format;
}

}  // namespace

int foam_label_bits(GlobalIndex cells, GlobalIndex faces, GlobalIndex points, GlobalIndex corners_of_part) {
  // Numbers of faces are written from 1.
  const GlobalIndex largest = std::max({cells, faces + 1, points, corners_of_part + 1});
  return largest > std::numeric_limits<std::int32_t>::max() ? 64 : 32;
}

void write_openfoam(const FileMesh& mesh, const std::string& folder, const OpenFoamOptions& options) {
  const parallel::Communicator& communicator = mesh.communicator();
  const mesh::FaceLinks links = mesh::link_faces(*mesh.pieces);
  const FoamPlan plan = plan_faces(mesh, links);
  const FoamMesh whole{
      mesh, plan, {foam_patches(mesh.patches), foam_words(mesh.regions)}, format_of(mesh, plan, options)};
  const FoamCase foam_case{folder, mesh.part_count};
  FoamFlow flow{mesh.flow};
  flow.is_external = std::any_of(mesh.patches.begin(), mesh.patches.end(), [](const mesh::Patch& patch) {
    return patch.type == mesh::PatchType::farfield;
  });
  const std::optional<SharpEdgeCells> sharp = find_sharp_edge_cells(mesh);
  flow.has_fans = sharp.has_value();
  bool has_fields = true, has_sharp_edges = flow.has_fans;
  parallel::on_root(communicator, [&] {
    prepare_case(foam_case);
    remove_unfit_dictionaries(foam_case, flow.has_fans);
    has_sharp_edges = has_sharp_edges || asks_for_sharp_edges(foam_case);
  });
  has_sharp_edges = communicator.maximum(std::int64_t{has_sharp_edges}) > 0;
  try {
    parallel::agree(communicator, [&] {
      for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
        const MeshPart& part = mesh.parts[i];
        const FoamFaces order = order_faces(mesh, part, links.pieces[i], plan);
        FoamPartWriter(whole, part, order, foam_case.unfinished(part.id)).write();
        if (has_sharp_edges)
          write_sharp_edges(
              foam_case.unfinished(part.id) / FoamCase::sharp_edges_name,
              sharp ? std::span<const std::uint8_t>((*sharp)[i]) : std::span<const std::uint8_t>());
      }
      if (communicator.is_root()) has_fields = write_settings(foam_case, flow);
    });
  } catch (const parallel::CollectiveError&) {
    std::error_code ignored;
    for (const MeshPart& part : mesh.parts) fs::remove_all(foam_case.unfinished(part.id), ignored);
    throw;
  }
  parallel::on_root(communicator, [&] { retire_meshes(foam_case); });
  has_fields = communicator.maximum(std::int64_t{has_fields ? 0 : 1}) == 0;
  parallel::agree(communicator, [&] {
    for (const MeshPart& part : mesh.parts) {
      if (has_fields) write_fields(foam_case, part.id);
      fs::rename(foam_case.unfinished(part.id), foam_case.mesh(part.id));
      if (has_sharp_edges)
        fs::rename(foam_case.mesh(part.id) / FoamCase::sharp_edges_name, foam_case.sharp_edges(part.id));
    }
  });
}

std::string openfoam_scaling(double factor) {
  return fmt::format(
      "transformPoints -scale '({:g} {:g} {:g})', by mpirun with -parallel where there are parts", factor,
      factor, factor);
}

}  // namespace aeroloom::io
