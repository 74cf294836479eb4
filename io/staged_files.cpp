#include "io/staged_files.hpp"

#include "parallel/communication/collective_error.hpp"

#include <filesystem>
#include <system_error>
#include <vector>

namespace aeroloom::io {

namespace fs = std::filesystem;

namespace {

/// Of one file system with the place of the files: moving them copies nothing.
fs::path staging_of(const fs::path& folder, const std::string& name) {
  return folder / ("." + name + ".unfinished");
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

/// Files of the older of two folders that the newer does not have move over, unless it is numbered as parts
/// of a mesh are.
void keep_other_files(const fs::path& older, const fs::path& newer) {
  const std::string stem = newer.filename().string() + "_";
  for (const fs::directory_entry& entry : fs::directory_iterator(older)) {
    const fs::path name = entry.path().filename();
    const bool is_part = name.string().starts_with(stem) && !entry.is_directory();
    if (!is_part && !fs::exists(newer / name)) fs::rename(entry.path(), newer / name);
  }
}

/// Before anything is moved: all files appear, or none.
void require_places(const fs::path& staging, const fs::path& folder) {
  for (const fs::directory_entry& entry : fs::directory_iterator(staging)) {
    require_replaceable((folder / entry.path().filename()).string(),
                        entry.is_directory() ? Arrival::folder : Arrival::file);
  }
}

void publish(const fs::path& staging, const fs::path& folder) {
  require_places(staging, folder);
  std::vector<fs::path> files, folders;
  for (const fs::directory_entry& entry : fs::directory_iterator(staging))
    (entry.is_directory() ? folders : files).push_back(entry.path().filename());
  const fs::path older = staging / ".older";
  fs::create_directory(older);
  std::vector<fs::path> kept;
  for (const fs::path& name : folders) {
    if (fs::is_directory(fs::symlink_status(folder / name))) {
      fs::rename(folder / name, older / name);
      kept.push_back(name);
    } else if (fs::is_symlink(fs::symlink_status(folder / name))) {
      fs::rename(folder / name, older / name);  // the link goes, what it leads to stays
    }
    fs::rename(staging / name, folder / name);
  }
  for (const fs::path& name : files) fs::rename(staging / name, folder / name);
  for (const fs::path& name : kept) keep_other_files(older / name, folder / name);
  fs::remove_all(staging);
}

}  // namespace

void require_replaceable(const std::string& path, Arrival arrival) {
  const fs::file_status found = fs::symlink_status(path);
  if (!fs::exists(found) || fs::is_symlink(found)) return;
  if (arrival == Arrival::folder ? fs::is_directory(found) : fs::is_regular_file(found)) return;
  const bool is_folder = fs::is_directory(found);
  const char* const what = is_folder                    ? "a folder is in the way of a file"
                           : arrival == Arrival::folder ? "a file is in the way of a folder"
                                                        : "a device or a pipe is in the way of a file";
  throw fs::filesystem_error(
      std::string(what) + ". Remedy: move it away, or write into another folder", path,
      std::make_error_code(is_folder ? std::errc::is_a_directory : std::errc::file_exists));
}

void write_together(const parallel::Communicator& communicator, const std::string& folder,
                    const std::string& name, const std::function<void(const std::string& staging)>& work) {
  const fs::path place = folder.empty() ? "." : folder;
  const fs::path staging = staging_of(place, name);
  parallel::on_root(communicator, [&] {
    try {
      fs::create_directories(place);
      fs::remove_all(staging);
      fs::create_directory(staging);
    } catch (const fs::filesystem_error& error) {
      throw fs::filesystem_error("cannot write", place / name, error.code());
    }
  });
  const auto discard = [&] {
    std::error_code ignored;
    if (communicator.is_root()) fs::remove_all(staging, ignored);
  };
  try {
    work(staging.string());
    parallel::on_root(communicator, [&] { publish(staging, place); });
  } catch (const parallel::CollectiveError& error) {
    discard();
    const std::string where = folder.empty() ? "" : folder + "/";
    throw parallel::CollectiveError(error.kind(), replaced(error.what(), staging.string() + "/", where));
  } catch (...) {
    discard();
    throw;
  }
}

}  // namespace aeroloom::io
