// Damaged files end in a model or in a message, never in a crash, whatever is wrong with them.
#include "cad/model/model.hpp"
#include "pipeline/domain/sandboxed_cad.hpp"
#include "tests/scoped_fault.hpp"

#include <array>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <ios>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepTools.hxx>
#include <BinTools.hxx>
#include <IGESControl_Writer.hxx>
#include <STEPControl_Writer.hxx>
#include <TopoDS_Shape.hxx>
#include <gtest/gtest.h>
#include <unistd.h>

namespace aeroloom::pipeline {
namespace {

namespace fs = std::filesystem;

struct Variant {
  std::string name;
  std::string content;
  std::string extension;
};

std::string read_file(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

void write_file(const fs::path& file, const std::string& content) {
  std::ofstream(file, std::ios::binary) << content;
}

/// A plate with a hole in the formats that are read.
std::map<std::string, std::string> sound_files(const fs::path& folder) {
  const TopoDS_Shape plate = BRepPrimAPI_MakeBox(4, 2, 1).Shape();
  const TopoDS_Shape pin =
      BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(2, 1, -1), gp_Dir(0, 0, 1)), 0.5, 3).Shape();
  const TopoDS_Shape shape = BRepAlgoAPI_Cut(plate, pin).Shape();
  STEPControl_Writer step;
  step.Transfer(shape, STEPControl_AsIs);
  step.Write((folder / "sound.step").c_str());
  IGESControl_Writer iges("MM", 1);
  iges.AddShape(shape);
  iges.ComputeModel();
  iges.Write((folder / "sound.igs").c_str());
  BRepTools::Write(shape, (folder / "sound.brep").c_str());
  BinTools::Write(shape, (folder / "sound.bin.brep").c_str());
  return {{".step", read_file(folder / "sound.step")},
          {".igs", read_file(folder / "sound.igs")},
          {".brep", read_file(folder / "sound.brep")},
          {".bin.brep", read_file(folder / "sound.bin.brep")}};
}

/// The n-th number of a text, replaced.
std::string with_number(const std::string& text, std::size_t n, const std::string& number) {
  std::size_t at = 0;
  for (std::size_t seen = 0; at < text.size(); ++at) {
    const bool digit = std::isdigit(static_cast<unsigned char>(text[at])) != 0;
    const bool before = at > 0 && std::isalnum(static_cast<unsigned char>(text[at - 1])) != 0;
    if (digit && !before && seen++ == n) break;
  }
  std::size_t end = at;
  while (end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) || text[end] == '.'))
    ++end;
  return text.substr(0, at) + number + text.substr(end);
}

void add_truncated(const std::string& sound, const std::string& extension, std::vector<Variant>& variants) {
  constexpr std::size_t parts = 13;
  for (std::size_t i = 0; i < parts; ++i) {
    variants.push_back({"cut_" + std::to_string(i), sound.substr(0, sound.size() * i / parts), extension});
  }
}

void add_random(const std::string& sound, const std::string& extension, std::vector<Variant>& variants) {
  std::mt19937 random(20);
  const auto place = [&] { return random() % sound.size(); };
  for (int i = 0; i < 24; ++i) {
    std::string flipped = sound;
    for (int k = 0; k <= i % 4; ++k) flipped[place()] ^= static_cast<char>(1u << random() % 8);
    variants.push_back({"flip_" + std::to_string(i), flipped, extension});
  }
  for (int i = 0; i < 8; ++i) {
    std::string zeroed = sound, noisy = sound;
    const std::size_t from = place(), length = std::min<std::size_t>(40, sound.size() - from);
    for (std::size_t k = from; k < from + length; ++k) zeroed[k] = 0, noisy[k] = static_cast<char>(random());
    variants.push_back({"zeros_" + std::to_string(i), zeroed, extension});
    variants.push_back({"noise_" + std::to_string(i), noisy, extension});
  }
}

void add_numbers(const std::string& sound, const std::string& extension, std::vector<Variant>& variants) {
  const char* const numbers[] = {"nan", "1e308", "-99999999999", "4294967295", "0", ""};
  for (std::size_t i = 0; i < 12; ++i) {
    variants.push_back(
        {"number_" + std::to_string(i), with_number(sound, 10 + 37 * i, numbers[i % 6]), extension});
  }
}

void add_whole(const std::string& sound, const std::string& extension, std::vector<Variant>& variants) {
  const std::size_t half = sound.size() / 2;
  variants.push_back({"swapped", sound.substr(half) + sound.substr(0, half), extension});
  variants.push_back({"twice", sound + sound, extension});
  variants.push_back({"header", sound.substr(0, 400), extension});
  variants.push_back({"text", "This is a letter, not a model.\n" + sound.substr(half), extension});
  for (const char* wrong : {".igs", ".step", ".brep", ".stl"}) variants.push_back({"sound", sound, wrong});
}

std::vector<Variant> make_variants(const std::map<std::string, std::string>& files) {
  std::vector<Variant> variants;
  for (const auto& [extension, sound] : files) {
    add_truncated(sound, extension, variants);
    add_random(sound, extension, variants);
    add_numbers(sound, extension, variants);
    add_whole(sound, extension, variants);
  }
  return variants;
}

class DamagedFiles : public testing::Test {
protected:
  void SetUp() override { fs::create_directories(_folder); }
  void TearDown() override { fs::remove_all(_folder); }

  /// The message, empty where the file gave a model.
  std::string outcome(const fs::path& file) {
    cad::DomainOptions options;
    options.file = file.string();
    try {
      const cad::Domain domain = domain::prepare_sandboxed(options);
      EXPECT_GT(domain.model.face_count(), 0) << file;
      return {};
    } catch (const cad::CadError& error) {
      return error.what();
    } catch (const std::ios_base::failure& error) {
      return error.what();
    }
  }

  const fs::path _folder = fs::temp_directory_path() / ("aeroloom_damaged_" + std::to_string(::getpid()));
};

TEST_F(DamagedFiles, SoundOnesGiveAModel) {
  for (const auto& [extension, content] : sound_files(_folder)) {
    const fs::path file = _folder / ("plain" + extension);
    write_file(file, content);
    EXPECT_EQ(outcome(file), "") << extension;
  }
}

TEST_F(DamagedFiles, EndInAModelOrAMessage) {
  const std::vector<Variant> variants = make_variants(sound_files(_folder));
  ASSERT_GE(variants.size(), 200u);
  // One in five; benchmarks/damaged_files.py takes all.
  const std::size_t stride = std::getenv("AEROLOOM_ALL_DAMAGE") != nullptr ? 1 : 5;
  int models = 0, messages = 0, crashes = 0;
  for (std::size_t i = 0; i < variants.size(); i += stride) {
    const Variant& variant = variants[i];
    const fs::path file = _folder / (variant.name + variant.extension);
    write_file(file, variant.content);
    const std::string message = outcome(file);
    models += message.empty();
    if (message.empty()) continue;
    ++messages;
    crashes += message.find("the CAD library crashed") != std::string::npos;
    EXPECT_NE(message.find(file.filename().string()), std::string::npos) << message;
    EXPECT_GT(message.size(), file.string().size() + 10) << message;
  }
  RecordProperty("models", models);
  RecordProperty("messages", messages);
  RecordProperty("contained_crashes", crashes);
  std::printf("%d models, %d messages, %d of them contained crashes\n", models, messages, crashes);
  EXPECT_GT(messages, models / 2);
}

TEST_F(DamagedFiles, CrashesAndHangsOfTheCadLibraryBecomeMessages) {
  const std::map<std::string, std::string> expected{
      {"throws", "injected fault: an exception"}, {"aborts", "crashed"}, {"exhausts_memory", "memory"}};
  for (const auto& [fault, words] : expected) {
    cad::DomainOptions options;
    options.file = (_folder / "any.step").string();
    const ScopedFault injected("domain=" + fault);
    try {
      domain::prepare_sandboxed(options);
      ADD_FAILURE() << words;
    } catch (const cad::CadError& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("any.step"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace aeroloom::pipeline
