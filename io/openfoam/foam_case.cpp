#include "io/openfoam/foam_case.hpp"

#include "io/distinct_names.hpp"
#include "io/local_file.hpp"
#include "parallel/log.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>

#include <fmt/format.h>

namespace aeroloom::io {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t longest_foam_word = 120;

bool is_digit(char letter) {
  return letter >= '0' && letter <= '9';
}

std::string word_of(const std::string& name) {
  std::string word = name.empty() ? "unnamed" : name;
  for (char& letter : word) {
    const bool stays = is_digit(letter) || (letter >= 'a' && letter <= 'z') ||
                       (letter >= 'A' && letter <= 'Z') || letter == '_' || letter == '-' || letter == '.' ||
                       static_cast<unsigned char>(letter) >= 0x80;
    if (!stays) letter = '_';
  }
  // A word that begins like a number would be read as one; patches between parts have names of their own.
  const bool like_number = is_digit(word[0]) || word[0] == '-' || word[0] == '.';
  if (like_number || word.starts_with("procBoundary")) word.insert(word.begin(), '_');
  return word;
}

/// The number of a processor folder, -1 of any other.
std::int64_t processor_of(const std::string& name) {
  const std::string prefix = "processor";
  if (!name.starts_with(prefix) || name.size() == prefix.size() || name.size() > prefix.size() + 9) return -1;
  const std::string digits = name.substr(prefix.size());
  return std::all_of(digits.begin(), digits.end(), is_digit) ? std::stoll(digits) : -1;
}

/// Removes a folder that holds nothing.
void remove_if_empty(const fs::path& folder) {
  if (fs::is_directory(folder) && fs::is_empty(folder)) fs::remove(folder);
}

/// Whether there is more in a processor folder than a mesh.
bool holds_results(const fs::path& processor) {
  for (const auto& entry : fs::directory_iterator(processor)) {
    if (entry.path().filename() != "constant") return true;
    for (const auto& inner : fs::directory_iterator(entry.path())) {
      const fs::path name = inner.path().filename();
      if (name != "polyMesh" && name != "polyMesh.unfinished") return true;
    }
  }
  return false;
}

std::string dictionary(const std::string& name, const std::string& content) {
  return fmt::format(
      "FoamFile\n{{\n    version     2.0;\n    format      ascii;\n    class       dictionary;\n    location "
      "   "
      "\"system\";\n    object      {};\n}}\n\n{}",
      name, content);
}

std::string decomposition(std::int64_t parts) {
  return fmt::format("numberOfSubdomains {};\nmethod          scotch;\n", parts);
}

/// Empty where there is no such file, or it is too large for a dictionary.
std::string text_of(const fs::path& path) {
  constexpr std::uintmax_t largest = 1 << 20;
  if (!fs::is_regular_file(path) || fs::file_size(path) > largest) return {};
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// What a decomposeParDict says; 0: nothing.
std::int64_t subdomains_of(const fs::path& path) {
  const std::string text = text_of(path), word = "numberOfSubdomains";
  const std::size_t at = text.find(word);
  if (at == std::string::npos) return 0;
  std::istringstream rest(text.substr(at + word.size(), 100));
  std::int64_t count = 0;
  return rest >> count ? count : 0;
}

constexpr char control[] = R"foam(application     simpleFoam;
startFrom       latestTime;
startTime       0;
stopAt          endTime;
endTime         1000;
deltaT          1;
writeControl    timeStep;
writeInterval   100;
writeFormat     binary;
writePrecision  12;
timeFormat      general;
runTimeModifiable true;
)foam";

// Schemes for tetrahedra: limited corrections for faces that are not orthogonal.
constexpr char schemes[] = R"foam(ddtSchemes      { default steadyState; }
gradSchemes     { default leastSquares; grad(U) cellLimited leastSquares 1; }
divSchemes
{
    default         bounded Gauss upwind;
    div(phi,U)      bounded Gauss linearUpwind grad(U);
    div((nuEff*dev2(T(grad(U))))) Gauss linear;
    div(div(phi,U)) Gauss linear;
}
laplacianSchemes { default Gauss linear limited 0.777; }
interpolationSchemes { default linear; }
snGradSchemes   { default limited 0.777; }
wallDist        { method meshWave; }
)foam";

constexpr char solution[] = R"foam(solvers
{
    "(p|Phi)"
    {
        solver          GAMG;
        smoother        GaussSeidel;
        tolerance       1e-8;
        relTol          0.01;
    }
    "(U|k|omega|epsilon|nuTilda)"
    {
        solver          smoothSolver;
        smoother        symGaussSeidel;
        tolerance       1e-9;
        relTol          0.1;
    }
}
potentialFlow   { nNonOrthogonalCorrectors 5; PhiRefCell 0; PhiRefValue 0; pRefCell 0; pRefValue 0; }
SIMPLE          { nNonOrthogonalCorrectors 1; consistent yes; pRefCell 0; pRefValue 0; }
relaxationFactors { equations { U 0.7; ".*" 0.7; } }
)foam";

}  // namespace

fs::path FoamCase::constant(std::int32_t part) const {
  return parts == 1 ? folder / "constant" : folder / fmt::format("processor{}", part) / "constant";
}

void clear_case(const FoamCase& foam_case) {
  fs::create_directories(foam_case.folder);
  std::vector<fs::path> processors;
  for (const auto& entry : fs::directory_iterator(foam_case.folder)) {
    const std::int64_t number = processor_of(entry.path().filename().string());
    if (number < 0 || !entry.is_directory()) continue;
    processors.push_back(entry.path());
    const bool is_beyond = foam_case.parts == 1 || number >= foam_case.parts;
    if (is_beyond && holds_results(entry.path())) {
      throw fs::filesystem_error(
          fmt::format("the mesh has {} part(s), this folder holds results of more: remove it",
                      foam_case.parts),
          entry.path(), std::make_error_code(std::errc::directory_not_empty));
    }
  }
  processors.push_back(foam_case.folder);
  for (const fs::path& place : processors) {
    fs::remove_all(place / "constant" / "polyMesh");
    fs::remove_all(place / "constant" / "polyMesh.unfinished");
    if (place == foam_case.folder) continue;
    remove_if_empty(place / "constant");
    remove_if_empty(place);
  }
}

void write_dictionaries(const FoamCase& foam_case) {
  const fs::path system = foam_case.folder / "system";
  fs::create_directories(system);
  const auto write = [&](const char* name, const std::string& content) {
    const fs::path path = system / name;
    if (fs::exists(path)) return;
    const fs::path unfinished = path.string() + ".unfinished";
    LocalFile file(unfinished.string());
    file.text(dictionary(name, content));
    file.finish();
    fs::rename(unfinished, path);
  };
  write("controlDict", control);
  write("fvSchemes", schemes);
  write("fvSolution", solution);
  if (foam_case.parts == 1) return;
  const fs::path old = system / "decomposeParDict";
  const std::int64_t subdomains = subdomains_of(old);
  if (subdomains > 0 && subdomains != foam_case.parts) {
    if (text_of(old) == dictionary("decomposeParDict", decomposition(subdomains))) {
      fs::remove(old);
    } else {
      parallel::log_warning(
          fmt::format("'{}' has numberOfSubdomains {}, but the mesh has {} parts: change it", old.string(),
                      subdomains, foam_case.parts));
    }
  }
  write("decomposeParDict", decomposition(foam_case.parts));
}

std::vector<std::string> foam_words(const std::vector<std::string>& names) {
  return distinct_names(names, longest_foam_word, word_of);
}

}  // namespace aeroloom::io
