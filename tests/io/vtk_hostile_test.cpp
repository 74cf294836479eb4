#include "io/raw_mesh.hpp"
#include "io/vtk/vtk_reader.hpp"
#include "io/vtk/vtk_writer.hpp"
#include "tests/io/damage.hpp"
#include "tests/io/scratch_folder.hpp"
#include "tests/io/vtk_grids.hpp"

#include <string>

namespace aeroloom::io {
namespace {

using examples::FileForm;
using parallel::Communicator;

class VtkHostile : public examples::ScratchFolder {
protected:
  damage::Outcome survive(const std::string& good, const std::string& name, const damage::Options& options) {
    return damage::survive(
        world, good, path(name),
        [&](const std::string& file) {
          assemble(read_vtk({world, file}), 2);
        },
        options);
  }
  /// Fewer than for readers of our own, for each case runs in a process of its own; and few on several ranks,
  /// which do nothing different but wait for each other.
  damage::Options options = world.size() == 1
                                ? damage::Options{.truncations = 40, .flips = 120, .fields = 30, .pieces = 20}
                                : damage::Options{.truncations = 24, .flips = 16, .fields = 4, .pieces = 4};
  const examples::MixedMesh whole = examples::MixedMesh(2, 2);
};

TEST_F(VtkHostile, DamagedGridsOfOthers) {
  for (const char* name : {"grid.vtu", "grid.vtk"}) {
    for (const FileForm form : {FileForm::raw, FileForm::packed, FileForm::text}) {
      const std::string good = path(std::string("good_") + name);
      if (world.is_root())
        write_grid(*examples::make_grid(whole, {.label = "CellEntityIds", .with_ids = true}), good, form);
      world.barrier();
      ++options.seed;
      const damage::Outcome outcome = survive(examples::bytes_of(good), name, options);
      EXPECT_GT(outcome.refused, outcome.cases / 4) << name;
      EXPECT_GT(outcome.accepted, 0) << name << ": names and spare arrays do not matter";
    }
  }
}

TEST_F(VtkHostile, DamagedPartsOfOurOwn) {
  write_volume(examples::mixed_mesh(world, 2, 2), folder, "mesh");
  const std::string good = examples::bytes_of(folder / "mesh" / "mesh_000000.vtu");
  const damage::Outcome outcome = survive(good, "part.vtu", options);
  EXPECT_GT(outcome.refused, outcome.cases / 4);
}

TEST_F(VtkHostile, DamagedIndices) {
  write_volume(examples::mixed_mesh(world, 2, 2), folder, "mesh");
  const damage::Outcome outcome = survive(examples::bytes_of(path("mesh.pvtu")), "other.pvtu", options);
  EXPECT_GT(outcome.refused, outcome.cases / 4);
}

}  // namespace
}  // namespace aeroloom::io
