#include "pipeline/case/option_keys.hpp"

#include "tests/source_tree.hpp"

#include <fstream>
#include <regex>
#include <string>

#include <gtest/gtest.h>

namespace aeroloom::cases {
namespace {

TEST(OptionKeys, OptionsAreNamedByTheKeysThatSetThem) {
  EXPECT_EQ(with_keys("smaller pieces (VolumeOptions::piece_tets) or SizingOptions::minimum"),
            "smaller pieces (volume.piece_tets) or sizing.minimum");
  EXPECT_EQ(with_keys("take them as bodies (DomainOptions::kind: body)"),
            "take them as bodies (geometry.domain: body)");
  EXPECT_EQ(with_keys("FarFieldOptions::symmetry and FarFieldOptions::symmetry_position"),
            "farfield.symmetry and farfield.symmetry_position");
  EXPECT_EQ(with_keys("SizingOptions::piece_tets, VolumeOptions::piece_tets_too, FarFieldOptions::"),
            "SizingOptions::piece_tets, VolumeOptions::piece_tets_too, FarFieldOptions::");
  EXPECT_EQ(with_keys("nothing to name"), "nothing to name");
}

/// A message of a stage that names an option without a key would send users to the sources.
TEST(OptionKeys, EveryOptionThatAMessageNamesHasAKey) {
  const std::regex quoted(R"re("[^"]*\w+Options::\w+[^"]*")re");
  int named = 0;
  for (const char* room : {"cad", "mesh", "sizing", "surface", "volume", "improve", "pipeline/domain"}) {
    for (const auto& file : std::filesystem::recursive_directory_iterator(source_tree() / room)) {
      if (file.path().extension() != ".cpp" && file.path().extension() != ".hpp") continue;
      std::ifstream stream(file.path());
      for (std::string line; std::getline(stream, line);) {
        if (line.find("Options::") == std::string::npos || !std::regex_search(line, quoted)) continue;
        EXPECT_EQ(with_keys(line).find("Options::"), std::string::npos) << file.path() << ": " << line;
        ++named;
      }
    }
  }
  EXPECT_GT(named, 10);
}

}  // namespace
}  // namespace aeroloom::cases
