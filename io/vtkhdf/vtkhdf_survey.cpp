#include "io/vtkhdf/vtkhdf_survey.hpp"

#include "io/hdf5/input_file.hpp"

#include <array>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::io::vtkhdf {

using hdf5::ArrayFacts;
using hdf5::InputFile;
using hdf5::ItemKind;

namespace {

/// The arrays that are asked for, in this order.
enum Array : std::uint8_t {
  group,
  number_of_points,
  number_of_cells,
  number_of_corners,
  points,
  connectivity,
  offsets,
  types,
  own_ids,
  usual_ids,
  regions,
  patches,
  ghosts,
  region_names,
  patch_names,
  patch_types,
  face_corners,
  face_offsets,
  face_types,
  face_patches,
  face_patch_names,
  face_patch_types,
  array_count,
};
constexpr std::array<const char*, array_count> array_names = {
    "/VTKHDF",
    "/VTKHDF/NumberOfPoints",
    "/VTKHDF/NumberOfCells",
    "/VTKHDF/NumberOfConnectivityIds",
    "/VTKHDF/Points",
    "/VTKHDF/Connectivity",
    "/VTKHDF/Offsets",
    "/VTKHDF/Types",
    "/VTKHDF/PointData/global_id",
    "/VTKHDF/PointData/GlobalPointIds",
    "/VTKHDF/CellData/region",
    "/VTKHDF/CellData/patch",
    "/VTKHDF/CellData/vtkGhostType",
    "/VTKHDF/FieldData/region_names",
    "/VTKHDF/FieldData/patch_names",
    "/VTKHDF/FieldData/patch_types",
    "/Boundary/Connectivity",
    "/Boundary/Offsets",
    "/Boundary/Types",
    "/Boundary/Patch",
    "/Boundary/PatchNames",
    "/Boundary/PatchTypes",
};

class Surveyor {
public:
  explicit Surveyor(const std::string& path) : _file(path) {
    hdf5::SurveyRequest request;
    request.arrays.assign(array_names.begin(), array_names.end());
    request.attributes = {{"/VTKHDF", "Type"}, {"/VTKHDF/Steps", "NSteps"}};
    request.group = "/VTKHDF/PointData";
    request.mark = {"GlobalIds", "Attribute"};
    _survey = _file.survey(request);
  }

  FileFacts find() {
    check_type();
    FileFacts facts;
    find_partitions(facts);
    check_grid(facts);
    find_ids(facts);
    facts.has_regions = has_column(regions, facts.all().cells);
    facts.has_patches = has_column(patches, facts.all().cells);
    facts.has_ghosts = has_column(ghosts, facts.all().cells);
    facts.region_names = texts(region_names);
    // A group of this name with other things in it is somebody else's.
    facts.has_boundary = array(face_patches).exists() && array(face_patch_names).kind == ItemKind::text;
    if (facts.has_boundary) find_boundary(facts);
    facts.patch_names = texts(facts.has_boundary ? face_patch_names : patch_names);
    facts.patch_types = texts(facts.has_boundary ? face_patch_types : patch_types);
    return facts;
  }

private:
  const ArrayFacts& array(Array which) const { return _survey.arrays[which]; }
  [[noreturn]] void fail(const std::string& text) const {
    throw std::runtime_error(_file.path() + ": " + text);
  }

  void check_type() const {
    if (!array(group).exists()) fail("no VTKHDF file: it has no group /VTKHDF");
    const std::string& type = _survey.attributes[0];
    if (type.empty()) fail("the group /VTKHDF has no attribute Type");
    if (type != "UnstructuredGrid")
      fail(fmt::format("it holds data of type {}; only UnstructuredGrid can be read", type));
    const std::string& steps = _survey.attributes[1];
    if (!steps.empty() && steps != "1")
      fail(fmt::format("it holds {} time steps; save one of them alone", steps));
  }

  /// Throws unless the array is there, of this kind and length (-1: any).
  void require_array(Array which, ItemKind kind, std::int64_t rows, std::size_t rank = 1) const {
    const ArrayFacts& facts = array(which);
    const char* name = array_names[which];
    if (!facts.exists()) fail(fmt::format("it has no array {}", name));
    if (facts.kind != kind || facts.dimensions.size() != rank) {
      fail(fmt::format("{} is no array of {} with {} {}", name, kind == ItemKind::real ? "reals" : "integers",
                       rank, rank == 1 ? "dimension" : "dimensions"));
    }
    if (rows >= 0 && facts.rows() != rows)
      fail(fmt::format("{} has {} rows where the counts of the file ask for {}", name, facts.rows(), rows));
  }

  bool has_column(Array which, std::int64_t rows) const {
    if (!array(which).exists()) return false;
    require_array(which, ItemKind::integer, rows);
    return true;
  }

  std::vector<std::string> texts(Array which) const {
    return array(which).kind == ItemKind::text ? _file.texts(array_names[which]) : std::vector<std::string>();
  }

  std::vector<std::int64_t> counts(Array which, std::int64_t rows) const {
    require_array(which, ItemKind::integer, rows);
    std::vector<std::int64_t> items = _file.integers(array_names[which], 0, array(which).rows());
    std::int64_t all = 0;
    for (std::size_t p = 0; p < items.size(); ++p) {
      if (items[p] < 0 || __builtin_add_overflow(all, items[p], &all))
        fail(fmt::format("{} is {} for partition {}", array_names[which], items[p], p));
    }
    return items;
  }

  void find_partitions(FileFacts& facts) const {
    const std::vector<std::int64_t> point_counts = counts(number_of_points, -1);
    const auto rows = static_cast<std::int64_t>(point_counts.size());
    const std::vector<std::int64_t> cell_counts = counts(number_of_cells, rows);
    const std::vector<std::int64_t> corner_counts = counts(number_of_corners, rows);
    std::vector<GridCounts> partitions;
    for (std::size_t p = 0; p < point_counts.size(); ++p) {
      partitions.push_back({point_counts[p], cell_counts[p], corner_counts[p]});
      if (cell_counts[p] == 0 && corner_counts[p] > 0)
        fail(fmt::format("partition {} has {} corners, but no cells", p, corner_counts[p]));
    }
    facts.before = sums_before(partitions);
  }

  void check_grid(const FileFacts& facts) const {
    const GridCounts& all = facts.all();
    require_array(points, ItemKind::real, all.points, 2);
    if (array(points).dimensions[1] != 3)
      fail(fmt::format("{} has {} columns, not 3", array_names[points], array(points).dimensions[1]));
    require_array(connectivity, ItemKind::integer, all.corners);
    require_array(types, ItemKind::integer, all.cells);
    const auto partitions = static_cast<std::int64_t>(facts.partition_count());
    std::int64_t offset_count = 0;
    if (__builtin_add_overflow(all.cells, partitions, &offset_count)) fail("it claims too many cells");
    require_array(offsets, ItemKind::integer, offset_count);
  }

  void find_ids(FileFacts& facts) const {
    if (has_column(own_ids, facts.all().points)) {
      facts.id_array = array_names[own_ids];
    } else if (!_survey.marked.empty()) {
      facts.id_array = "/VTKHDF/PointData/" + _survey.marked;
      const ArrayFacts marked = _file.survey({{facts.id_array}, {}, "", {}}).arrays[0];
      if (marked.kind != ItemKind::integer || marked.dimensions != std::vector{facts.all().points})
        fail(fmt::format("{} is no array of {} integers", facts.id_array, facts.all().points));
    } else if (has_column(usual_ids, facts.all().points)) {
      facts.id_array = array_names[usual_ids];
    } else {
      std::size_t with_points = 0;
      for (std::size_t p = 0; p < facts.partition_count(); ++p)
        with_points += facts.before[p + 1].points > facts.before[p].points ? 1 : 0;
      if (with_points > 1) {
        fail(
            fmt::format("its points lie in {} partitions without global ids, so nothing says which of them "
                        "are one; write the point data global_id (in ParaView: Generate Global Ids), or one "
                        "partition",
                        with_points));
      }
    }
  }

  void find_boundary(FileFacts& facts) const {
    require_array(face_types, ItemKind::integer, -1);
    facts.boundary_faces = array(face_types).rows();
    require_array(face_offsets, ItemKind::integer, facts.boundary_faces + 1);
    require_array(face_patches, ItemKind::integer, facts.boundary_faces);
    require_array(face_corners, ItemKind::integer, -1);
    facts.boundary_corners = array(face_corners).rows();
  }

  InputFile _file;
  hdf5::Survey _survey;
};

}  // namespace

FileFacts survey_file(const std::string& path) {
  return Surveyor(path).find();
}

}  // namespace aeroloom::io::vtkhdf
