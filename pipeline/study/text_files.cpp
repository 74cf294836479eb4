#include "pipeline/study/text_files.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::study {

std::string read_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (stream) text << stream.rdbuf();
  if (!stream)
    throw std::runtime_error(fmt::format("cannot read '{}': {}", file.string(), std::strerror(errno)));
  return text.str();
}

void write_file(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  const std::filesystem::path unfinished = file.string() + ".unfinished";
  std::filesystem::remove(unfinished);  // whatever it points to stays
  std::ofstream stream(unfinished, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream)
    throw std::runtime_error(fmt::format("cannot write '{}': {}", unfinished.string(), std::strerror(errno)));
  std::filesystem::rename(unfinished, file);
}

}  // namespace aeroloom::study
