// The pictures of a run: which there are, that they are the same for any number of ranks, and what remains of
// them when the volume fails.
#include "pipeline/report/pictures.hpp"

#include "parallel/communication/collective_error.hpp"
#include "pipeline/run.hpp"
#include "tests/references.hpp"
#include "tests/scoped_fault.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace aeroloom::report {
namespace {

using parallel::Communicator;

/// A coarse mesh of the built-in aircraft, in a folder of its own.
cases::Case coarse_aircraft(const std::string& name) {
  cases::Case input;
  input.domain.transport.emplace();
  input.domain.far_field.emplace();
  input.domain.far_field->extent = 3;
  input.sizing.minimum = input.sizing.feature_minimum = 0.5;
  input.sizing.maximum = 20;
  input.sizing.surface_maximum = 4;
  input.sizing.curvature_angle = 30;
  input.sizing.growth = 1.8;
  input.sizing.proximity = 0;
  input.output.directory =
      std::filesystem::temp_directory_path() / ("aeroloom_pictures_" + name + std::to_string(::getpid()));
  input.output.formats = {io::FileFormat::vtu};
  return input;
}

std::vector<std::string> names_of(const std::vector<Picture>& pictures) {
  std::vector<std::string> names;
  for (const Picture& picture : pictures) names.push_back(picture.name);
  return names;
}

/// All of them, for comparison.
std::string text_of(const std::vector<Picture>& pictures) {
  std::string text;
  for (const Picture& picture : pictures) {
    text += fmt::format("{}: {}\n", picture.name, picture.caption);
    text.append(picture.png.begin(), picture.png.end());
  }
  return text;
}

/// Runs the case in a folder that goes afterwards.
RunRecord record_of(const Communicator& communicator, cases::Case input) {
  parallel::Bytes name = parallel::to_bytes(std::span<const char>(input.output.directory));
  communicator.broadcast(name);
  const std::vector<char> letters = parallel::from_bytes<char>(name);
  input.output.directory.assign(letters.begin(), letters.end());
  RunRecord record;
  try {
    pipeline::run_case(communicator, input, record);
  } catch (const StageFailure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::volume) << failure.what();
  }
  communicator.barrier();
  if (communicator.is_root()) std::filesystem::remove_all(input.output.directory);
  return record;
}

TEST(Pictures, OfTheAircraftAreTheSameForAnyNumberOfRanks) {
  const Communicator world = Communicator::world();
  const std::vector<Picture> pictures = record_of(world, coarse_aircraft("a")).pictures;
  if (!world.is_root()) {
    EXPECT_TRUE(pictures.empty());
    return;
  }
  EXPECT_EQ(names_of(pictures), (std::vector<std::string>{"body", "views", "leading_edge", "junction", "cut",
                                                          "leading_edge_cut"}));
  std::size_t bytes = 0;
  for (const Picture& picture : pictures) {
    bytes += picture.png.size();
    EXPECT_FALSE(picture.caption.empty());
    EXPECT_FALSE(picture.legend.empty());
    EXPECT_GT(picture.width * picture.height, 100'000);
  }
  EXPECT_LT(bytes, 1'500'000U);
  std::set<std::string> colours, patches;
  for (const LegendItem& item : pictures[0].legend) {
    colours.insert(item.colour), patches.insert(item.name);
    EXPECT_EQ(item.colour.size(), 7U);
  }
  EXPECT_EQ(colours.size(), pictures[0].legend.size()) << "each patch has a colour of its own";
  EXPECT_TRUE(patches.count("fuselage") && !patches.count("farfield"));
  EXPECT_EQ(text_of(pictures), references::of_one_rank(world, text_of(pictures), [] {
              return text_of(record_of(Communicator::self(), coarse_aircraft("b")).pictures);
            }));
}

TEST(Pictures, OfLayersHaveTheirNumbers) {
  const Communicator world = Communicator::world();
  const auto with_layers = [](const std::string& name) {
    cases::Case input = coarse_aircraft(name);
    input.layers.given = true;
    input.layers.first = 0.05;
    return input;
  };
  const std::vector<Picture> pictures = record_of(world, with_layers("e")).pictures;
  if (!world.is_root()) return;
  ASSERT_FALSE(pictures.empty());
  EXPECT_EQ(pictures.back().name, "layers");
  std::set<std::string> names;
  for (const LegendItem& item : pictures.back().legend) names.insert(item.name);
  EXPECT_EQ(names.size(), pictures.back().legend.size());
  EXPECT_GT(names.size(), 2U) << "there are layers";
  EXPECT_EQ(text_of(pictures), references::of_one_rank(world, text_of(pictures), [&] {
              return text_of(record_of(Communicator::self(), with_layers("f")).pictures);
            }));
}

TEST(Pictures, OfTheSurfaceRemainWhereTheVolumeFailsIfTheyAreWanted) {
  const Communicator world = Communicator::world();
  cases::Case input = coarse_aircraft("c");
  input.volume.retries = 1;
  const ScopedFault injected("zone=throws");
  const std::vector<std::string> expected{"body", "views", "leading_edge", "junction"};
  EXPECT_EQ(names_of(record_of(world, input).pictures),
            world.is_root() ? expected : std::vector<std::string>{});
  input.output.pictures = false;
  input.sizing.minimum = 2;  // without them, any surface will do
  input.sizing.surface_maximum = 8;
  EXPECT_TRUE(record_of(world, input).pictures.empty());
}

}  // namespace
}  // namespace aeroloom::report
