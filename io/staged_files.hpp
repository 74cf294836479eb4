/// Files that appear together, or not at all.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <functional>
#include <string>

namespace aeroloom::io {

/// Has `work` write into a folder FOLDER/.NAME.unfinished, made anew, and moves what is there to FOLDER when
/// all ranks have succeeded: until then all files of an earlier mesh stay as they were, and after it none of
/// those of the same names do. A folder replaces one of its name as a whole; what is in the older one and has
/// no name of a part (FOLDER_...) is kept. Where anything fails, the folder goes, and messages name files as
/// if they were in FOLDER. What a killed run left there goes with the next. Collective; throws
/// CollectiveError.
void write_together(const parallel::Communicator& communicator, const std::string& folder,
                    const std::string& name, const std::function<void(const std::string& staging)>& work);

}  // namespace aeroloom::io
