// picture_files CASE.yaml|MESH FOLDER [section.key=value ...]: the pictures of a run, or of a mesh as it is,
// as files in a folder, for who wants to look at them.
#include "io/import/imported_mesh.hpp"
#include "mesh/data/boundary_mesh.hpp"
#include "parallel/communication/environment.hpp"
#include "parallel/sandbox/sandbox.hpp"
#include "pipeline/report/pictures.hpp"
#include "pipeline/run.hpp"

#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace aeroloom::pipeline {
namespace {

std::vector<report::Picture> pictures_of_mesh(const parallel::Communicator& world, const std::string& file) {
  const mesh::DistributedMesh volume = imported::import_mesh({world, file}, 100'000);
  const mesh::NumberedMesh surface = mesh::number_mesh(mesh::boundary_mesh(mesh::number_mesh(volume)));
  const std::clock_t begin = std::clock();
  std::vector<report::Picture> pictures =
      report::pictures_or_warning(world, &volume, {surface, volume.patch_types, ""});
  if (world.is_root())
    std::printf("pictures: %.2f s of CPU\n", double(std::clock() - begin) / CLOCKS_PER_SEC);
  return pictures;
}

void write_pictures(const std::vector<std::string>& arguments) {
  const auto world = parallel::Communicator::world();
  std::vector<report::Picture> pictures;
  if (arguments.at(1).ends_with(".yaml")) {
    report::RunRecord record;
    run_case(world, cases::read_case(arguments[1], {arguments.begin() + 3, arguments.end()}), record);
    pictures = record.pictures;
  } else {
    pictures = pictures_of_mesh(world, arguments[1]);
  }
  std::filesystem::create_directories(arguments.at(2));
  for (const report::Picture& picture : pictures) {
    std::ofstream(arguments[2] + "/" + picture.name + ".png", std::ios::binary)
        .write(reinterpret_cast<const char*>(picture.png.data()),
               static_cast<std::streamsize>(picture.png.size()));
    std::printf("%s: %dx%d, %zu bytes: %s\n", picture.name.c_str(), picture.width, picture.height,
                picture.png.size(), picture.caption.c_str());
  }
}

}  // namespace
}  // namespace aeroloom::pipeline

int main(int argc, char** argv) {
  using namespace aeroloom;
  const parallel::Environment environment(argc, argv);
  try {
    pipeline::write_pictures({argv, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
