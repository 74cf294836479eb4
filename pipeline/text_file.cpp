#include "pipeline/text_file.hpp"

#include <filesystem>
#include <fstream>
#include <ios>
#include <iterator>
#include <system_error>

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
  const std::string unfinished = file + ".unfinished";
  std::ofstream stream(unfinished, std::ios::binary);
  stream << text;
  stream.close();
  std::error_code error;
  if (stream) std::filesystem::rename(unfinished, file, error);
  if (stream && !error) return;
  std::filesystem::remove(unfinished, error);
  throw std::ios_base::failure("cannot write '" + file + "'");
}

}  // namespace aeroloom::pipeline
