/// The rows of the table agree with what formats do: names, ends, and what of a mesh comes back from its
/// files.
#include "io/file_formats.hpp"
#include "io/read_mesh.hpp"
#include "io/write_mesh.hpp"
#include "parallel/observation/warnings.hpp"
#include "tests/io/mixed_mesh.hpp"
#include "tests/io/scratch_folder.hpp"
#include "tests/source_tree.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::io {
namespace {

using FormatTable = examples::ScratchFolder;

/// Ends that files are known by, each once.
template <class Ends>
void expect_apart(const Ends& ends) {
  for (auto a = ends.begin(); a != ends.end(); ++a) {
    for (auto b = ends.begin(); b != ends.end(); ++b)
      EXPECT_TRUE(a == b || !a->ends_with(*b)) << *a << " ends with " << *b;
  }
}

TEST_F(FormatTable, NamesLeadBackToTheirFormats) {
  std::set<std::string_view> names;
  for (const FormatRow& row : file_formats()) {
    EXPECT_EQ(&row_of(row.format), &row);
    EXPECT_EQ(format_called(row.name), row.format);
    EXPECT_EQ(name_of(row.format), row.name);
    EXPECT_NE(row.write, nullptr) << row.name;
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
  }
  EXPECT_EQ(format_called("vt"), std::nullopt);
  EXPECT_EQ(format_called(""), std::nullopt);
}

TEST_F(FormatTable, EndsOfPathsLeadBackToTheirFormats) {
  std::vector<std::string> first, further;
  for (const FormatRow& row : file_formats()) {
    ASSERT_FALSE(row.ends.front().empty()) << row.name;
    for (const std::string_view end : row.ends) {
      if (end.empty()) continue;
      EXPECT_EQ(written_path(row.format, "a/b" + std::string(end)), "a/b" + std::string(end));
      const std::optional<FileFormat> format = format_of_path("a/b" + std::string(end));
      ASSERT_TRUE(format) << end;
      // The first of several parts ends like the whole.
      if (format != row.format) {
        EXPECT_EQ(row_of(*format).ends.front(), row.replaced_end) << end;
      } else {
        (end == row.ends.front() ? first : further).emplace_back(end);
      }
    }
  }
  // A message names each of them, those of a run's output first.
  std::vector<std::string> known = first;
  known.insert(known.end(), further.begin(), further.end());
  expect_apart(known);
  EXPECT_EQ(known_extensions(), fmt::format("{}", fmt::join(known, ", ")));
  EXPECT_TRUE(known_extensions().starts_with(".pvtu, .vtkhdf, .cgns, .lb8.ugrid, .lb8l.ugrid, .su2, "));
  EXPECT_EQ(format_of_path("mesh.b8l.ugrid"), FileFormat::ugrid64);
  EXPECT_EQ(format_of_path("mesh.mesh"), FileFormat::meshb);
  EXPECT_EQ(format_of_path("mesh_1.msh"), FileFormat::msh);
  for (const char* other : {"mesh.stl", "mesh.vtu", "mesh.ugrid", "mesh"})
    EXPECT_EQ(format_of_path(other), std::nullopt) << other;
}

TEST_F(FormatTable, NamesOfWrittenFilesAreReplacedWhereViewersGoByThem) {
  for (const FormatRow& row : file_formats()) {
    const std::string first(row.ends.front());
    EXPECT_EQ(written_path(row.format, "a/b"), row.replaced_end.empty() ? "a/b" : "a/b" + first) << row.name;
    if (row.replaced_end.empty()) continue;
    EXPECT_EQ(written_path(row.format, "a/b" + std::string(row.replaced_end)), "a/b" + first);
  }
}

TEST_F(FormatTable, ReadableEndsLeadToTheReaderOfTheirFormat) {
  std::vector<std::string> ends;
  std::set<std::string_view> descriptions;
  for (const FormatRow& row : file_formats()) {
    for (const ReadableEnd& end : row.readable_ends) {
      if (end.text.empty()) continue;
      const ReadableFile file = readable_file("a/b" + std::string(end.text));
      EXPECT_EQ(file.row, &row) << end.text;
      EXPECT_EQ(file.end, &end) << end.text;
      EXPECT_FALSE(end.description.empty()) << end.text;
      EXPECT_TRUE(descriptions.insert(end.description).second) << end.text;
      ends.emplace_back(end.text);
    }
    // What a run has written is read by the same reader, or not at all.
    const ReadableFile written = readable_file("mesh" + std::string(row.ends.front()));
    EXPECT_EQ(written.row == nullptr, row.read == nullptr) << row.name;
    if (written.row == nullptr) continue;
    EXPECT_EQ(written.row->read, row.read) << row.name;
  }
  expect_apart(ends);
  EXPECT_EQ(readable_extensions(), ends);
  EXPECT_EQ(readable_file("mesh.stl").row, nullptr);
}

/// The bytes of all files below a folder, one after another.
std::string all_bytes(const std::filesystem::path& folder) {
  std::string all;
  for (const auto& [file, bytes] : examples::files_below(folder)) all += bytes;
  return all;
}

mesh::GlobalIndex interface_faces(const FileMesh& mesh) {
  mesh::GlobalIndex faces = 0;
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    if (mesh.patches[p].type == mesh::PatchType::interior)
      faces = std::accumulate(mesh.patch_faces[p].begin(), mesh.patch_faces[p].end(), faces);
  }
  return faces;
}

/// Warnings of names are not those of what is lost.
void leave_out_names(parallel::Warnings& warnings) {
  std::erase_if(warnings.kept, [](const auto& each) {
    return each.message.find("cannot hold the name") != std::string::npos;
  });
}

TEST_F(FormatTable, WhatFilesHoldIsWhatTheRowSays) {
  const FileMesh mesh = examples::mixed_mesh(world, 4, 3);
  ASSERT_EQ(mesh.regions.size(), 2U);
  ASSERT_GT(interface_faces(mesh), 0);
  for (const FormatRow& row : file_formats()) {
    const std::string file = path(std::string(row.name) + "/some" + std::string(row.ends.front()));
    if (world.is_root()) std::filesystem::create_directories(path(std::string(row.name)));
    world.barrier();
    parallel::take_warnings(world);
    write_mesh(mesh, row.format, file, {.surface = true});
    parallel::Warnings warnings = parallel::take_warnings(world);
    leave_out_names(warnings);
    const bool is_whole = row.content.regions && row.content.interfaces;
    if (world.is_root()) {
      EXPECT_EQ(warnings.kept.empty(), is_whole) << row.name;
      const std::string text = warnings.kept.empty() ? "" : warnings.kept.front().message;
      EXPECT_EQ(text.find("2 regions") == std::string::npos, row.content.regions) << row.name;
      EXPECT_EQ(text.find("'interface'") == std::string::npos, row.content.interfaces) << row.name;
    }
    if (row.read == nullptr) {
      const std::string bytes = all_bytes(path(std::string(row.name)));
      EXPECT_EQ(bytes.find("upper") != std::string::npos, row.content.regions) << row.name;
      EXPECT_EQ(bytes.find("interface") != std::string::npos, row.content.interfaces) << row.name;
      continue;
    }
    const FileMesh read = read_mesh({world, file}, 2).mesh;
    EXPECT_EQ(read.regions.size(), row.content.regions ? 2U : 1U) << row.name;
    EXPECT_EQ(interface_faces(read), row.content.interfaces ? interface_faces(mesh) : 0) << row.name;
  }
}

TEST_F(FormatTable, NamesThatFilesCannotHoldAreSaid) {
  FileMesh mesh = examples::mixed_mesh(world, 3, 2);
  const std::string longer = "upper_surface_of_the_left_wing_and_flap", shorter = longer.substr(0, 32);
  mesh.patches[2].name = longer;
  const std::map<FileFormat, std::string> held{{FileFormat::cgns, shorter}, {FileFormat::su2, shorter},
                                               {FileFormat::su2b, shorter}, {FileFormat::ugrid, ""},
                                               {FileFormat::msh, ""},       {FileFormat::vtkhdf, ""}};
  for (const auto& [format, name] : held) {
    const std::string file = path("names" + std::string(row_of(format).ends.front()));
    parallel::take_warnings(world);
    write_mesh(mesh, format, file, {});
    std::string text;
    for (const auto& each : parallel::take_warnings(world).kept) text += each.message + "\n";
    if (!world.is_root()) continue;
    const std::string said = fmt::format("cannot hold the name '{}': it is '{}' there", longer, name);
    EXPECT_EQ(text.find(said) != std::string::npos, !name.empty()) << file << ": " << text;
    const bool has_blanks = format == FileFormat::msh || format == FileFormat::vtkhdf;
    EXPECT_EQ(text.find("'wing / lower side'") == std::string::npos, has_blanks) << file << ": " << text;
  }
}

TEST_F(FormatTable, NamesInBytesAreRead) {
  const FileMesh mesh = examples::mixed_mesh(world, 3, 2);
  const std::string file = path("bytes.lb8.ugrid");
  write_mesh(mesh, FileFormat::ugrid, file, {});
  const std::string companion = path("bytes.mapbc");
  if (world.is_root()) {
    std::ifstream stream(companion, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(stream), {}};
    text.replace(text.find("symmetry"), 8, "Fl\xFCgel");
    std::ofstream(companion, std::ios::binary) << text;
  }
  world.barrier();
  EXPECT_EQ(read_mesh({world, file}, 2).mesh.patches[1].name, "Fl\xC3\xBCgel");
}

TEST_F(FormatTable, WarningsNameFormatsThatKeepTheWholeMesh) {
  parallel::take_warnings(world);
  write_mesh(examples::mixed_mesh(world, 3, 2), FileFormat::su2, path("some.su2"), {});
  parallel::Warnings warnings = parallel::take_warnings(world);
  leave_out_names(warnings);
  if (!world.is_root()) return;
  ASSERT_EQ(warnings.kept.size(), 1U);
  std::string text = warnings.kept[0].message;
  const std::size_t begin = text.find("left out; "), end = text.find(" keep ");
  ASSERT_NE(begin, std::string::npos) << text;
  ASSERT_NE(end, std::string::npos) << text;
  text = text.substr(begin + 10, end - begin - 10);
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream words(text);
  int formats = 0;
  for (std::string word; words >> word;) {
    if (word == "and") continue;
    const std::optional<FileFormat> format = format_called(word);
    ASSERT_TRUE(format) << word;
    EXPECT_TRUE(row_of(*format).content.regions && row_of(*format).content.interfaces) << word;
    ++formats;
  }
  EXPECT_EQ(formats, 4);
}

TEST_F(FormatTable, PartsAreThoseAskedForWhereThereAreParts) {
  const FileMesh mesh = examples::mixed_mesh(world, 4, 3);
  for (const FormatRow& row : file_formats()) {
    std::map<int, std::map<std::string, std::string>> files;
    for (const int parts : {2, 4}) {
      const std::filesystem::path to = folder / fmt::format("{}_{}", row.name, parts);
      if (world.is_root()) std::filesystem::create_directories(to);
      world.barrier();
      write_mesh(mesh, row.format, (to / ("some" + std::string(row.ends.front()))).string(),
                 {.parts = parts});
      world.barrier();
      files[parts] = examples::files_below(to);
    }
    EXPECT_EQ(files[2] != files[4], row.content.parts) << row.name;
  }
}

TEST_F(FormatTable, LaterPartsOfAnEarlierMeshGo) {
  for (const FormatRow& row : file_formats()) {
    if (row.remove_later_parts == nullptr) continue;
    EXPECT_TRUE(row.content.parts) << row.name;
    const std::string file = path("some" + std::string(row.ends.front()));
    const FileMesh mesh = examples::mixed_mesh(world, 4, 3);
    const auto written = [&](int parts) {
      write_mesh(mesh, row.format, file, {.parts = parts});
      world.barrier();
      auto files = examples::files_below(folder);
      world.barrier();
      return files;
    };
    const auto few = written(2), many = written(4);
    EXPECT_EQ(few.size() + 2, many.size()) << row.name;
    row.remove_later_parts({world, file}, 3);
    world.barrier();
    EXPECT_EQ(examples::files_below(folder).size() + 1, many.size()) << row.name;
    world.barrier();
    EXPECT_EQ(written(2), few) << row.name;
  }
}

TEST_F(FormatTable, FilesNameTheirParts) {
  for (const FormatRow& row : file_formats()) {
    if (row.named_parts == nullptr) continue;
    const std::string file = path("some" + std::string(row.ends.front()));
    write_mesh(examples::mixed_mesh(world, 4, 3), row.format, file, {});
    world.barrier();
    EXPECT_EQ(row.named_parts(file), static_cast<int>(examples::files_below(path("some")).size()))
        << row.name;
    EXPECT_EQ(row.named_parts(path("some.vtu")), 0);
  }
}

TEST_F(FormatTable, SolversOfTheseFormatsTakeLengthsForMetres) {
  for (const FileFormat format : {FileFormat::openfoam, FileFormat::su2, FileFormat::su2b, FileFormat::cgns})
    EXPECT_TRUE(row_of(format).in_metres) << name_of(format);
  EXPECT_FALSE(row_of(FileFormat::vtu).in_metres);
  EXPECT_EQ(row_of(FileFormat::openfoam).scaling(0.001),
            "transformPoints -scale '(0.001 0.001 0.001)', by mpirun with -parallel where there are parts");
}

/// Each format has a row in the table of the page, which says whether it is read.
TEST_F(FormatTable, ThePageOfFormatsHasEachRow) {
  std::ifstream page(source_tree() / "docs/formats.md");
  std::map<std::string, std::string> rows;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("| `")) rows.emplace(line.substr(3, line.find('`', 3) - 3), line);
  }
  for (const FormatRow& row : file_formats()) {
    ASSERT_TRUE(rows.contains(std::string(row.name))) << row.name;
    const std::string& line = rows.at(std::string(row.name));
    EXPECT_EQ(line.find("| yes |") != std::string::npos, row.read != nullptr) << line;
    EXPECT_EQ(line.find("| no |") != std::string::npos, row.read == nullptr) << line;
  }
}

}  // namespace
}  // namespace aeroloom::io
