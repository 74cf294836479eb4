/// Writes several files that appear together, or not at all.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <functional>
#include <string>

namespace aeroloom::io {

/// Calls `work` with the new folder FOLDER/.NAME.unfinished, and moves the files from there to FOLDER when
/// all ranks have succeeded. Until then all files of an earlier mesh stay as they are. A moved folder
/// replaces an older one of its name, but files without the name of a part (FOLDER_...) are kept. On failure
/// the staging folder is removed, and messages name files as if they were in FOLDER. The next run removes the
/// staging folder of a killed run. Collective; throws CollectiveError.
void write_together(const parallel::Communicator& communicator, const std::string& folder,
                    const std::string& name, const std::function<void(const std::string& staging)>& work);

}  // namespace aeroloom::io
