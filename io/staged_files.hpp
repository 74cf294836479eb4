/// Writes several files that appear together, or not at all.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <functional>
#include <string>

namespace aeroloom::io {

/// What is to appear at a path.
enum class Arrival : bool { file, folder };

/// Throws std::filesystem::filesystem_error where something is in the way of a new file or folder at `path`:
/// a file of a folder; a folder, a device or a pipe of a file. What is there of the same kind is replaced,
/// and so is a link, whatever it leads to. Not collective.
void require_replaceable(const std::string& path, Arrival arrival);

/// Calls `work` with the new folder FOLDER/.NAME.unfinished, and moves the files from there to FOLDER when
/// all ranks have succeeded. Until then all files of an earlier mesh stay as they are. A moved folder
/// replaces an older one of its name, or a link, but files without the name of a part (FOLDER_...) are kept.
/// On failure the staging folder is removed, and messages name files as if they were in FOLDER. The next run
/// removes the staging folder of a killed run. Collective; throws CollectiveError.
void write_together(const parallel::Communicator& communicator, const std::string& folder,
                    const std::string& name, const std::function<void(const std::string& staging)>& work);

}  // namespace aeroloom::io
