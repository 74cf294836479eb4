#include "io/cgns/cgns_layout.hpp"

#include "io/cgns/cgns_names.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

namespace aeroloom::io::cgns {

using hdf5::FileLayout;
using hdf5::ItemType;

namespace {

struct ShapeName {
  int corners;
  std::int32_t type;
  const char* ending;
};
/// What the sections of regions, or of patches, have in common.
template <std::size_t N>
struct SectionKind {
  const char* stand_in;  ///< for names that are not fit
  bool is_taken;         ///< names are among the nodes' already
  std::array<ShapeName, N> shapes;
};
const SectionKind<cell_shape_count> region_sections = {
    "Region", false, {{{4, 10, "_TETRA_4"}, {5, 12, "_PYRA_5"}, {6, 14, "_PENTA_6"}, {8, 17, "_HEXA_8"}}}};
const SectionKind<face_shape_count> patch_sections = {"Patch", true, {{{3, 5, "_TRI_3"}, {4, 7, "_QUAD_4"}}}};

/// Of mass, length, time, temperature and angle.
constexpr std::array<float, 5> exponents_of_length = {0, 1, 0, 0, 0};

constexpr const char* zone_name = "Zone";
constexpr std::array<const char*, 3> coordinate_names = {"CoordinateX", "CoordinateY", "CoordinateZ"};

const char* condition_of(mesh::PatchType type) {
  switch (type) {
    case mesh::PatchType::slip:
      return "BCWallInviscid";
    case mesh::PatchType::symmetry:
      return "BCSymmetryPlane";
    case mesh::PatchType::farfield:
      return "BCFarfield";
    case mesh::PatchType::inlet:
      return "BCInflow";
    case mesh::PatchType::outlet:
      return "BCOutflow";
    default:
      return "BCWallViscous";
  }
}

/// Adds the sections of one region or patch, called `name`; with the shape's ending where there are two.
template <std::size_t N>
std::array<std::int32_t, N> add_sections(Plan& plan, NodeNames& names, const SectionKind<N>& kind,
                                         const std::string& name,
                                         const std::array<mesh::GlobalIndex, N>& counts) {
  std::array<std::int32_t, N> places{};
  const bool single = std::count_if(counts.begin(), counts.end(), [](auto n) { return n > 0; }) == 1;
  for (std::size_t s = 0; s < N; ++s) {
    places[s] = -1;
    if (counts[s] == 0) continue;
    const char* const ending = single ? "" : kind.shapes[s].ending;
    Section section;
    section.name = single && kind.is_taken ? name : names.take(name, kind.stand_in, ending);
    if (!kind.is_taken && section.name != name + ending) section.full_name = name;
    section.type = kind.shapes[s].type;
    section.corners = kind.shapes[s].corners;
    section.first = plan.sections.empty() ? 1 : plan.sections.back().first + plan.sections.back().count;
    section.count = counts[s];
    places[s] = static_cast<std::int32_t>(plan.sections.size());
    plan.sections.push_back(std::move(section));
  }
  return places;
}

/// Fit names of patches stay as they are; names that must change give way to them.
std::vector<std::string> names_of_patches(const Totals& totals, NodeNames& names) {
  std::vector<std::string> result(totals.patches.size());
  for (const bool fit : {true, false}) {
    for (std::size_t p = 0; p < result.size(); ++p) {
      const std::string& name = totals.patches[p].name;
      const bool is_empty = totals.patch_faces[p] == decltype(totals.patch_faces[p]){};
      if (is_fit(name) == fit && !is_empty && totals.patches[p].type != mesh::PatchType::interior)
        result[p] = names.take(name, "Patch");
    }
  }
  return result;
}

ItemType index_type_of(const Plan& plan) {
  mesh::GlobalIndex largest = plan.vertices;
  for (const Section& section : plan.sections)
    largest = std::max({largest, section.first + section.count - 1, section.count * section.corners});
  return largest <= std::numeric_limits<std::int32_t>::max() ? ItemType::int32 : ItemType::int64;
}

/// The nodes of a file: groups with the attributes of ADF, their data in an array beside their children.
class Tree {
public:
  Tree() : _file(hdf5::MemberOrder::as_made) {
    set_attributes("/", "HDF5 MotherNode", "Root Node of HDF5 File", "MT");
    _file.store(std::string("/ format"), std::span<const std::int8_t>(chars("IEEE_LITTLE_32", 15)));
    _file.store(std::string("/ hdf5version"), std::span<const std::int8_t>(chars("HDF5 Version 1.10", 33)));
  }

  FileLayout& file() { return _file; }

  /// A node without data; its path.
  std::string add(const std::string& parent, const std::string& name, const char* label,
                  const char* type = "MT") {
    std::string path = parent + "/" + name;
    _file.add_group(path);
    set_attributes(path, name, label, type);
    const std::array<std::int32_t, 1> flags = {1};
    _file.set_integers(path, "flags", flags);
    return path;
  }
  std::string add_text(const std::string& parent, const std::string& name, const char* label,
                       const std::string& text) {
    std::string path = add(parent, name, label, "C1");
    _file.store(path + "/ data", std::span<const std::int8_t>(chars(text, text.size())));
    return path;
  }
  void add_floats(const std::string& parent, const std::string& name, const char* label,
                  std::span<const float> values) {
    std::string path = add(parent, name, label, "R4");
    const std::array dimensions = {static_cast<std::int64_t>(values.size())};
    _file.store_bytes(path + "/ data", ItemType::float32, dimensions, std::as_bytes(values));
  }
  /// Lines of equal length.
  void add_table(const std::string& parent, const std::string& name, const char* label,
                 const std::string& text, std::int64_t lines) {
    std::string path = add(parent, name, label, "C1");
    const std::array dimensions = {lines, static_cast<std::int64_t>(text.size()) / lines};
    _file.store_bytes(path + "/ data", ItemType::int8, dimensions, std::as_bytes(std::span(text)));
  }
  std::string add_integers(const std::string& parent, const std::string& name, const char* label,
                           std::span<const std::int32_t> values) {
    std::string path = add(parent, name, label, "I4");
    _file.store(path + "/ data", values);
    return path;
  }
  /// Integers of the width of indices; `columns` 0 for an array of one dimension.
  std::string add_indices(const std::string& parent, const std::string& name, const char* label,
                          ItemType width, std::span<const std::int64_t> values, std::int64_t columns = 0) {
    const bool narrow = width == ItemType::int32;
    std::string path = add(parent, name, label, narrow ? "I4" : "I8");
    std::vector<std::int64_t> dimensions = {static_cast<std::int64_t>(values.size())};
    if (columns > 0) dimensions = {dimensions[0] / columns, columns};
    const std::vector<std::int32_t> small(values.begin(), values.end());
    _file.store_bytes(path + "/ data", width, dimensions,
                      narrow ? std::as_bytes(std::span(small)) : std::as_bytes(values));
    return path;
  }
  /// An array that ranks fill; its offset in the file.
  std::int64_t reserve(const std::string& parent, const std::string& name, ItemType type,
                       const char* type_code, std::int64_t count) {
    const std::string path = add(parent, name, "DataArray_t", type_code);
    return _file.reserve(path + "/ data", type, count);
  }

private:
  static std::vector<std::int8_t> chars(const std::string& text, std::size_t bytes) {
    std::vector<std::int8_t> result(bytes);
    std::memcpy(result.data(), text.data(), std::min(text.size(), bytes));
    return result;
  }
  void set_attributes(const std::string& path, const std::string& name, const char* label, const char* type) {
    _file.set_text(path, "name", name, longest_name + 1);
    _file.set_text(path, "label", label, longest_name + 1);
    _file.set_text(path, "type", type, 3);
  }

  FileLayout _file;
};

/// Lengths are in a unit, and the file does not know which: mass, length, time, temperature, angle.
void add_units(Tree& tree, const std::string& base) {
  tree.add_text(base, "DataClass", "DataClass_t", "Dimensional");
  std::vector<std::string> words = {"Null", "UserDefined", "Null", "Null", "Null"};
  std::string text;
  for (std::string& word : words) {
    word.resize(longest_name, ' ');
    text += word;
  }
  tree.add_table(base, "DimensionalUnits", "DimensionalUnits_t", text,
                 static_cast<std::int64_t>(words.size()));
}

void add_elements(Tree& tree, const std::string& zone, Plan& plan) {
  const bool narrow = plan.index_type == ItemType::int32;
  for (Section& section : plan.sections) {
    const std::array<std::int32_t, 2> type = {section.type, 0};
    const std::string path = tree.add_integers(zone, section.name, "Elements_t", type);
    const std::array<std::int64_t, 2> range = {section.first, section.first + section.count - 1};
    tree.add_indices(path, "ElementRange", "IndexRange_t", plan.index_type, range);
    section.offset = tree.reserve(path, "ElementConnectivity", plan.index_type, narrow ? "I4" : "I8",
                                  section.count * section.corners);
    if (!section.full_name.empty()) tree.add_text(path, "FullName", "Descriptor_t", section.full_name);
  }
}

void add_conditions(Tree& tree, const std::string& zone, const Plan& plan) {
  if (plan.boundaries.empty()) return;
  const std::string all = tree.add(zone, "ZoneBC", "ZoneBC_t");
  for (const Boundary& boundary : plan.boundaries) {
    const std::string path = tree.add_text(all, boundary.name, "BC_t", "FamilySpecified");
    const std::array<std::int64_t, 2> range = {boundary.first, boundary.last};
    tree.add_indices(path, "PointRange", "IndexRange_t", plan.index_type, range, 1);
    tree.add_text(path, "GridLocation", "GridLocation_t", "FaceCenter");
    tree.add_text(path, "FamilyName", "FamilyName_t", boundary.name);
  }
}

void add_families(Tree& tree, const std::string& base, const Plan& plan) {
  for (const Boundary& boundary : plan.boundaries) {
    const std::string path = tree.add(base, boundary.name, "Family_t");
    tree.add_text(path, "FamilyBC", "FamilyBC_t", boundary.condition);
    if (!boundary.full_name.empty()) tree.add_text(path, "FullName", "Descriptor_t", boundary.full_name);
  }
}

}  // namespace

Plan plan_file(const Totals& totals) {
  Plan plan;
  plan.vertices = totals.vertex_count;
  NodeNames names;
  for (const char* name :
       {zone_name, "DataClass", "DimensionalUnits", "ZoneType", "GridCoordinates", "ZoneBC"})
    names.reserve(name);
  const std::vector<std::string> patch_names = names_of_patches(totals, names);
  for (std::size_t r = 0; r < totals.regions.size(); ++r) {
    const std::size_t before = plan.sections.size();
    plan.section_of_region.push_back(
        add_sections(plan, names, region_sections, totals.regions[r], totals.region_cells[r]));
    for (std::size_t s = before; s < plan.sections.size(); ++s) plan.cells += plan.sections[s].count;
  }
  for (std::size_t p = 0; p < totals.patches.size(); ++p) {
    plan.section_of_patch.push_back({-1, -1});
    if (patch_names[p].empty()) continue;
    const std::size_t before = plan.sections.size();
    plan.section_of_patch[p] =
        add_sections(plan, names, patch_sections, patch_names[p], totals.patch_faces[p]);
    const Section& last = plan.sections.back();
    plan.boundaries.push_back(
        {patch_names[p], patch_names[p] == totals.patches[p].name ? "" : totals.patches[p].name,
         condition_of(totals.patches[p].type), plan.sections[before].first, last.first + last.count - 1});
  }
  plan.index_type = index_type_of(plan);
  return plan;
}

std::vector<hdf5::Extent> lay_out(Plan& plan) {
  Tree tree;
  const std::array<float, 1> version = {3.4F};
  tree.add_floats("", "CGNSLibraryVersion", "CGNSLibraryVersion_t", version);
  const std::array<std::int32_t, 2> dimensions = {3, 3};
  const std::string base = tree.add_integers("", "Base", "CGNSBase_t", dimensions);
  add_units(tree, base);
  const std::array<std::int64_t, 3> sizes = {plan.vertices, plan.cells, 0};
  const std::string zone = tree.add_indices(base, zone_name, "Zone_t", plan.index_type, sizes, 1);
  tree.add_text(zone, "ZoneType", "ZoneType_t", "Unstructured");
  const std::string grid = tree.add(zone, "GridCoordinates", "GridCoordinates_t");
  for (std::size_t axis = 0; axis < coordinate_names.size(); ++axis) {
    plan.coordinates[axis] =
        tree.reserve(grid, coordinate_names[axis], ItemType::float64, "R8", plan.vertices);
    tree.add_floats(grid + "/" + coordinate_names[axis], "DimensionalExponents", "DimensionalExponents_t",
                    exponents_of_length);
  }
  add_elements(tree, zone, plan);
  add_conditions(tree, zone, plan);
  add_families(tree, base, plan);
  return tree.file().finish();
}

}  // namespace aeroloom::io::cgns
