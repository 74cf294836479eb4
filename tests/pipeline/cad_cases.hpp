// Cases on shapes of the CAD library, for tests of the whole program in one process.
#pragma once

#include "parallel/communication/collective_error.hpp"
#include "parallel/communication/communicator.hpp"
#include "pipeline/run.hpp"
#include "tests/references.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shape.hxx>
#include <unistd.h>

namespace aeroloom::pipeline::cad_cases {

/// A folder that all ranks of this test share and that goes with it.
class Folder {
public:
  Folder() {
    const auto world = parallel::Communicator::world();
    parallel::Bytes name;
    if (world.is_root()) {
      _path = std::filesystem::temp_directory_path() / ("aeroloom_cad_" + std::to_string(::getpid()));
      std::filesystem::create_directories(_path);
      const std::string text = _path.string();
      for (const char letter : text) name.push_back(static_cast<std::byte>(letter));
    }
    world.broadcast(name);
    std::string text;
    for (const std::byte letter : name) text.push_back(static_cast<char>(letter));
    _path = text;
  }
  ~Folder() {
    const auto world = parallel::Communicator::world();
    world.barrier();
    if (world.is_root()) std::filesystem::remove_all(_path);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  /// Writes a shape for all ranks to read.
  std::string write(const TopoDS_Shape& shape, const std::string& name) const {
    const auto world = parallel::Communicator::world();
    std::string file = (_path / name).string();
    if (world.is_root()) BRepTools::Write(shape, file.c_str());
    world.barrier();
    return file;
  }
  std::string path() const { return _path.string(); }

private:
  std::filesystem::path _path;
};

/// Shapes as one file has them.
inline TopoDS_Shape together(const std::vector<TopoDS_Shape>& shapes) {
  TopoDS_Compound compound;
  BRep_Builder builder;
  builder.MakeCompound(compound);
  for (const TopoDS_Shape& shape : shapes) builder.Add(compound, shape);
  return compound;
}

/// A coarse case on a file, without pictures, which have tests of their own.
inline cases::Case coarse_case(const std::string& file, const Folder& folder, double target) {
  cases::Case input;
  input.domain.file = file;
  input.sizing.target_tetrahedra = target;
  input.output.directory = folder.path() + "/out";
  input.output.log = parallel::LogLevel::quiet;
  input.output.pictures = false;
  return input;
}

/// Runs the case on all ranks together; the record, and in `alone` the hash of the mesh of one rank.
inline report::RunRecord run_twice(const cases::Case& input, std::string& alone) {
  const auto world = parallel::Communicator::world();
  report::RunRecord record;
  run_case(world, input, record);
  alone = record.hash;
  parallel::agree(world, [&] {
    if (!world.is_root()) return;
    alone = references::of_one_rank(world, record.hash, [&] {
      cases::Case again = input;
      again.output.directory += "_alone";
      report::RunRecord other;
      run_case(parallel::Communicator::self(), again, other);
      return other.hash;
    });
  });
  return record;
}

/// The parts of all walls with all layers and with none.
struct Coverage {
  double full = 0, none = 0;
};

inline Coverage coverage_of(const report::RunRecord& record) {
  double area = 0;
  Coverage sums;
  for (const layers::PatchLayers& of_patch : record.layers->report.patches)
    sums.full += of_patch.full_area, sums.none += of_patch.empty_area, area += of_patch.area;
  return {sums.full / area, sums.none / area};
}

}  // namespace aeroloom::pipeline::cad_cases
