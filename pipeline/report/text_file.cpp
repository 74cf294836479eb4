#include "pipeline/report/text_file.hpp"

#include "geometry/input_file.hpp"

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <ios>
#include <system_error>

namespace aeroloom::report {

namespace {

/// Why a stream has failed, as far as known.
std::error_code last_reason() {
  return {errno != 0 ? errno : EIO, std::generic_category()};
}

}  // namespace

std::string read_text(const std::string& file) {
  return geometry::read_whole(file);
}

void write_text(const std::string& file, const std::string& text) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(file).parent_path();
  std::error_code error;
  if (!folder.empty()) fs::create_directories(folder, error);
  if (error) throw std::ios_base::failure("cannot write '" + file + "'", error);
  // A link stays one; what is no file (a device, a pipe) is written as it stands.
  const bool linked = fs::is_symlink(fs::symlink_status(file, error));
  const fs::path target = linked ? fs::weakly_canonical(file, error) : fs::path(file);
  const bool replaced = !fs::exists(target, error) || fs::is_regular_file(target, error);
  const fs::path place = replaced ? fs::path(target.string() + ".unfinished") : target;
  if (replaced) fs::remove(place, error);  // a link too, not what it points to
  errno = 0;
  std::ofstream stream(place, std::ios::binary);
  stream << text;
  stream.close();
  std::error_code reason = last_reason();
  error.clear();
  if (stream && replaced) fs::rename(place, target, error);
  if (stream && !error) return;
  if (error) reason = error;
  if (replaced) fs::remove(place, error);
  throw std::ios_base::failure("cannot write '" + file + "'", reason);
}

void replace_text(const std::string& file, const std::string& text) {
  std::error_code ignored;  // what cannot be looked at cannot be written either, which is said then
  if (std::filesystem::is_symlink(std::filesystem::symlink_status(file, ignored)))
    std::filesystem::remove(file, ignored);
  write_text(file, text);
}

void print_text(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw std::ios_base::failure("cannot write to standard output");
}

}  // namespace aeroloom::report
