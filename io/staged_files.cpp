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

void publish(const fs::path& staging, const fs::path& folder) {
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
    }
    fs::rename(staging / name, folder / name);
  }
  for (const fs::path& name : files) fs::rename(staging / name, folder / name);
  for (const fs::path& name : kept) keep_other_files(older / name, folder / name);
  fs::remove_all(staging);
}

}  // namespace

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
