/// What the run on one rank gave, for those on more ranks to compare with: the entry on one rank keeps it,
/// the others find it (REFERENCES in cmake/AeroloomLibrary.cmake). Without, each makes its own.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <functional>
#include <string>

namespace aeroloom::references {

/// The text, such as a hash, that this place of the running test had on one rank: `here` where there is but
/// one, what was kept since the program was built, or what `make` gives on this rank. Call it on rank 0 of
/// `ranks` alone, the same times in each run of the test.
std::string of_one_rank(const parallel::Communicator& ranks, const std::string& here,
                        const std::function<std::string()>& make);

/// Expects that `outcome`, a text such as a hash, is the same on all ranks of the world, and what it is on
/// one. `outcome` is collective on the ranks that it is given.
void expect_as_on_one_rank(const std::function<std::string(const parallel::Communicator&)>& outcome);

}  // namespace aeroloom::references
