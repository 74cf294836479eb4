// Files of meshes in every format: the same bytes on any number of ranks, the same mesh from each that is
// read, and what was there before where there is no room.
#include "parallel/storage/digest.hpp"
#include "tests/pipeline/command_line.hpp"
#include "tests/references.hpp"

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace aeroloom::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr const char* all_formats =
    " --set output.formats=[vtu,vtkhdf,cgns,ugrid,ugrid64,su2,su2b,msh,msh_parts,meshb,openfoam]";

/// All files of a folder but what a run says of itself, with digests of their bytes.
std::map<std::string, std::string> digests_of(const fs::path& folder) {
  const std::set<std::string> said{"report.json", "report.html", "tasks.csv", ".lock"};
  std::map<std::string, std::string> digests;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file() || said.contains(entry.path().filename().string())) continue;
    std::ifstream stream(entry.path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    parallel::Digester digester;
    digester.text(bytes);
    digests[fs::relative(entry.path(), folder).string()] = digester.result().text();
  }
  return digests;
}

std::string lines_of(const std::map<std::string, std::string>& digests) {
  std::string lines;
  for (const auto& [name, digest] : digests) lines.append(name).append(" ").append(digest).append("\n");
  return lines;
}

class ConvertCommand : public CommandLine {
protected:
  void SetUp() override {
    CommandLine::SetUp();
    write("case.yaml", coarse_wing() + "patches:\n  sides: {faces: ['face_1', 'face_2'], type: slip}\n");
  }
};

TEST_F(ConvertCommand, RunsWriteTheSameBytesOnAnyNumberOfRanks) {
  const std::string line = std::string("run case.yaml -q --set output.parts=2") + all_formats;
  expect(0, line);
  const std::string here = lines_of(digests_of(folder / "out"));
  std::string alone = here;
  if (world.is_root()) {
    alone = references::of_one_rank(world, here, [&] {
      run_here(line + " --set output.directory=alone");
      return lines_of(digests_of(folder / "alone"));
    });
  }
  world.broadcast_value(alone);
  EXPECT_EQ(here, alone);
}

// Each format that is read gives the same points, cells and faces under the same numbers.
TEST_F(ConvertCommand, EachFormatComesBackAsTheMeshOfEveryOther) {
  expect(0, std::string("run case.yaml -q --set volume.piece_tets=1000000") + all_formats);
  const std::string wanted = read("out/mesh.su2b"), markers = read("out/mesh_markers.cfg");
  const std::set<std::string> keep_types{"mesh.pvtu", "mesh.vtkhdf", "mesh.msh", "mesh.meshb"};
  for (const std::string name : {"mesh.pvtu", "mesh.vtkhdf", "mesh.lb8.ugrid", "mesh.lb8l.ugrid", "mesh.su2",
                                 "mesh.su2b", "mesh.msh", "mesh.meshb"}) {
    const std::string back = "back/" + name;
    expect(0, "convert " + path("out/" + name) + " " + back + ".su2b", {"nothing to mend"});
    EXPECT_TRUE(read(back + ".su2b") == wanted) << name << " comes back as another mesh";
    if (!keep_types.contains(name)) continue;
    std::string read_back = read(back + "_markers.cfg");
    const std::size_t at = read_back.find(name + ".su2b");
    ASSERT_NE(at, std::string::npos) << read_back;
    EXPECT_EQ(read_back.replace(at, name.size() + 5, "mesh.su2b"), markers) << name;
  }
}

TEST_F(ConvertCommand, PartsBecomeOtherParts) {
  expect(0, "run case.yaml -q --set output.parts=2 --set output.formats=[msh_parts]");
  expect(0, "convert out/mesh_1.msh parts.vtkhdf --parts 5", {"nothing to mend"});
}

/// Room for so many bytes in any one file while it lives: how a full disk looks to a program.
class RoomInFiles {
public:
  explicit RoomInFiles(std::uintmax_t bytes) {
    getrlimit(RLIMIT_FSIZE, &_before);
    rlimit less = _before;
    less.rlim_cur = static_cast<rlim_t>(bytes);
    _is_set = setrlimit(RLIMIT_FSIZE, &less) == 0;
    _ignored = std::signal(SIGXFSZ, SIG_IGN);
  }
  ~RoomInFiles() {
    setrlimit(RLIMIT_FSIZE, &_before);
    std::signal(SIGXFSZ, _ignored);
  }
  RoomInFiles(const RoomInFiles&) = delete;
  RoomInFiles& operator=(const RoomInFiles&) = delete;
  bool is_set() const { return _is_set; }

private:
  rlimit _before{};
  bool _is_set = false;
  void (*_ignored)(int) = SIG_DFL;
};

// Files of a mesh appear together or not at all.
TEST_F(ConvertCommand, WhatWasThereIsWholeWhereThereIsNoRoom) {
  expect(0, "run case.yaml -q");
  expect(0, "run case.yaml -q --set output.directory=finer --set sizing.surface_maximum=1.5");
  const std::vector<std::string> targets = {"a.pvtu", "b.vtkhdf", "c.cgns",  "d.lb8.ugrid", "e.su2",
                                            "f.su2b", "g.msh",    "h.meshb", "foam/i.foam"};
  for (const std::string& target : targets)
    expect(0, "convert " + mesh() + " converted/" + target + " --parts 2");
  const std::map<std::string, std::string> before = digests_of(folder / "converted");
  for (const std::string& target : targets) {
    const std::string stem = target.substr(0, target.find_first_of("./"));
    std::uintmax_t largest = 0;  // of the files of this target
    for (const auto& entry : fs::recursive_directory_iterator(folder / "converted")) {
      const std::string name = fs::relative(entry.path(), folder / "converted").string();
      if (entry.is_regular_file() && name.substr(0, name.find_first_of("._/")) == stem)
        largest = std::max(largest, entry.file_size());
    }
    for (const std::uintmax_t room : {std::uintmax_t{4096}, largest / 2}) {
      const RoomInFiles limited(room);
      ASSERT_TRUE(limited.is_set());
      expect(7, "convert " + path("finer/mesh.pvtu") + " converted/" + target + " --parts 3");
    }
    EXPECT_EQ(digests_of(folder / "converted"), before) << target;
    world.barrier();
  }
}

}  // namespace
}  // namespace aeroloom::pipeline
