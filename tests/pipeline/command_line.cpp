#include "tests/pipeline/command_line.hpp"

#include "parallel/observation/log.hpp"
#include "parallel/observation/warnings.hpp"
#include "pipeline/commands/command_line.hpp"
#include "tests/source_tree.hpp"

#include <chrono>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <ostream>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace aeroloom::pipeline {

namespace fs = std::filesystem;

namespace {

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void flush_all() {
  std::cout.flush();
  std::cerr.flush();
  std::fflush(stdout);
  std::fflush(stderr);
}

/// Sends what is written to a descriptor into a file while it lives.
class Redirection {
public:
  Redirection(int descriptor, const fs::path& file)
      : _descriptor(descriptor), _before(fcntl(descriptor, F_DUPFD_CLOEXEC, 0)) {
    const int opened = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0644);
    if (_before < 0 || opened < 0 || dup2(opened, descriptor) < 0)
      throw std::system_error(errno, std::generic_category(), file.string());
    close(opened);
  }
  ~Redirection() {
    flush_all();
    dup2(_before, _descriptor);
    close(_before);
  }
  Redirection(const Redirection&) = delete;
  Redirection& operator=(const Redirection&) = delete;

private:
  int _descriptor, _before;
};

/// Blanks part words; quotes of either kind keep them together.
std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> words;
  bool within = false;
  char quote = 0;
  for (const char letter : line) {
    if (quote == 0 && letter == ' ') {
      within = false;
      continue;
    }
    if (!within) words.emplace_back();
    within = true;
    if (quote == 0 && (letter == '\'' || letter == '"'))
      quote = letter;
    else if (letter == quote)
      quote = 0;
    else
      words.back() += letter;
  }
  return words;
}

int run_words(const parallel::Communicator& ranks, const std::vector<std::string>& words) {
  std::vector<std::string> line = words;
  line.insert(line.begin(), "aeroloom");
  std::vector<char*> arguments;
  for (std::string& word : line) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  return run_command_line(ranks, static_cast<int>(line.size()), arguments.data());
}

}  // namespace

int count_of(const std::string& word, const std::string& text) {
  int count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

std::ostream& operator<<(std::ostream& stream, const CommandResult& ended) {
  return stream << "exit " << ended.code << "\n" << ended.out << ended.err;
}

void CommandLine::SetUp() {
  std::string name;
  if (world.is_root()) {
    name = (fs::temp_directory_path() / fmt::format("aeroloom_line_{}", getpid())).string();
    fs::remove_all(name);
    fs::create_directories(name);
    name = fs::canonical(name).string();
  }
  world.broadcast_value(name);
  folder = name;
  _left = fs::current_path();
  fs::current_path(folder);
  world.barrier();
}

void CommandLine::TearDown() {
  fs::current_path(_left);
  at_root([&] { fs::remove_all(folder); });
}

CommandResult CommandLine::run_on(const parallel::Communicator& ranks,
                                  const std::vector<std::string>& words) const {
  const fs::path said = fs::temp_directory_path() / fmt::format("aeroloom_said_{}", getpid());
  const fs::path out = said.string() + ".out", err = said.string() + ".err";
  CommandResult ended;
  const auto start = std::chrono::steady_clock::now();
  flush_all();
  {
    const Redirection facts(STDOUT_FILENO, out), troubles(STDERR_FILENO, err);
    ended.code = run_words(ranks, words);
  }
  ended.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  ended.out = content_of(out);
  ended.err = content_of(err);
  fs::remove(out);
  fs::remove(err);
  parallel::take_warnings(ranks);
  parallel::configure_log(ranks, parallel::LogLevel::quiet);
  return ended;
}

CommandResult CommandLine::run(const std::vector<std::string>& words) const {
  const CommandResult mine = run_on(world, words);
  EXPECT_EQ(world.minimum(std::int64_t{mine.code}), world.maximum(std::int64_t{mine.code}))
      << "ranks end with different codes";
  CommandResult all{mine.code, {}, {}, world.maximum(mine.seconds)};
  for (const std::string& text : world.all_gather_values(mine.out)) all.out += text;
  for (const std::string& text : world.all_gather_values(mine.err)) all.err += text;
  return all;
}

CommandResult CommandLine::run(const std::string& line) const {
  return run(words_of(line));
}

CommandResult CommandLine::run_here(const std::string& line) const {
  return run_on(parallel::Communicator::self(), words_of(line));
}

CommandResult CommandLine::run_alone(const std::string& line) const {
  CommandResult ended;
  if (world.is_root()) ended = run_here(line);
  parallel::configure_log(world, parallel::LogLevel::quiet);
  world.broadcast_value(ended.code);
  world.broadcast_value(ended.out);
  world.broadcast_value(ended.err);
  world.broadcast_value(ended.seconds);
  return ended;
}

CommandResult CommandLine::expect(int code, const std::string& line,
                                  const std::vector<std::string>& words) const {
  CommandResult ended = run(line);
  EXPECT_EQ(ended.code, code) << line << ": " << ended;
  for (const std::string& word : words)
    EXPECT_TRUE(ended.has(word)) << line << ": '" << word << "': " << ended;
  return ended;
}

std::string CommandLine::write(const std::string& name, const std::string& text) const {
  at_root([&] {
    fs::create_directories((folder / name).parent_path());
    std::ofstream(folder / name, std::ios::binary) << text;
  });
  return path(name);
}

std::string CommandLine::read(const std::string& name) const {
  return content_of(folder / name);
}

nlohmann::json CommandLine::read_json(const std::string& name) const {
  return nlohmann::json::parse(read(name));
}

std::string coarse_wing() {
  return fmt::format(R"(
geometry: {{file: "{}/tests/data/wing_body.step", trailing_edges: sharpen}}
farfield: {{shape: box, extent: 3}}
sizing: {{minimum: 0.5, feature_minimum: 0.5, maximum: 10, surface_maximum: 2, curvature_angle: 40, growth: 1.9, proximity: 0}}
output: {{pictures: false}}
)",
                     source_tree().string());
}

std::string coarse_duct() {
  return fmt::format(R"(
geometry: {{file: "{}/configs/geometry/duct.step", domain: fluid}}
sizing: {{target_tetrahedra: 2000}}
output: {{pictures: false}}
)",
                     source_tree().string());
}

std::string coarse_transport() {
  return R"(
geometry: {builtin: transport, trailing_edges: sharpen}
farfield: {shape: box, extent: 2}
sizing: {minimum: 0.5, feature_minimum: 0.5, maximum: 20, surface_maximum: 4, curvature_angle: 30, growth: 1.8, proximity: 0}
output: {pictures: false}
)";
}

std::string groups_case() {
  std::string text = content_of(source_tree() / "configs" / "groups.yaml");
  const std::string file = "geometry/duct.step";
  return text.replace(text.find(file), file.size(), (source_tree() / "configs" / file).string());
}

}  // namespace aeroloom::pipeline
