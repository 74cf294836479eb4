#include "pipeline/text_file.hpp"

#include <filesystem>
#include <fstream>
#include <ios>
#include <iterator>

namespace aeroloom::pipeline {

std::string read_text(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream) throw std::ios_base::failure("cannot read '" + file + "'");
  return text;
}

void write_text(const std::string& file, const std::string& text) {
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  if (!folder.empty()) std::filesystem::create_directories(folder);
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw std::ios_base::failure("cannot write '" + file + "'");
}

}  // namespace aeroloom::pipeline
