#include "pipeline/study/text_files.hpp"

#include "geometry/input_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace aeroloom::study {

std::string read_file(const std::filesystem::path& file) {
  if (const auto refusal = geometry::refusal_of(file.string()))
    throw std::runtime_error(fmt::format("cannot read '{}': {}", file.string(), refusal->what));
  return geometry::read_whole(file.string());
}

void refuse_json(const std::filesystem::path& file, const std::string& what, const std::exception& error) {
  // The library begins with the name of the exception, in brackets.
  std::string said = error.what();
  if (said.starts_with('[') && said.find("] ") != std::string::npos) said.erase(0, said.find("] ") + 2);
  throw std::runtime_error(fmt::format("'{}' is not {}: {}", file.string(), what, said));
}

nlohmann::ordered_json read_json(const std::filesystem::path& file) {
  const std::string text = read_file(file);
  try {
    nlohmann::ordered_json json = nlohmann::ordered_json::parse(text);
    if (!json.is_object())
      throw std::runtime_error(fmt::format("an object was expected, not {}", json.type_name()));
    return json;
  } catch (const std::exception& error) {
    refuse_json(file, "whole JSON", error);
  }
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
