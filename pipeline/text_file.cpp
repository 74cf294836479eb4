#include "pipeline/text_file.hpp"

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <ios>
#include <iterator>
#include <system_error>

namespace aeroloom::pipeline {

namespace {

/// Why a stream has failed, as far as the system has told.
std::error_code last_reason() {
  return {errno != 0 ? errno : EIO, std::generic_category()};
}

}  // namespace

std::string read_text(const std::string& file) {
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream) throw std::ios_base::failure("cannot read '" + file + "'", last_reason());
  return text;
}

void write_text(const std::string& file, const std::string& text) {
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error) throw std::ios_base::failure("cannot write '" + file + "'", error);
  const std::string unfinished = file + ".unfinished";
  errno = 0;
  std::ofstream stream(unfinished, std::ios::binary);
  stream << text;
  stream.close();
  std::error_code reason = last_reason();
  if (stream) std::filesystem::rename(unfinished, file, error);
  if (stream && !error) return;
  if (error) reason = error;
  std::filesystem::remove(unfinished, error);
  throw std::ios_base::failure("cannot write '" + file + "'", reason);
}

}  // namespace aeroloom::pipeline
