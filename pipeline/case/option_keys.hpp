/// From the options of the stages, as their messages name them, to the keys of a case.
#pragma once

#include <string>

namespace aeroloom::cases {

/// The message with `VolumeOptions::piece_tets` and the like replaced by the key that is declared to set the
/// option: `volume.piece_tets`. Others stay as they are.
std::string with_keys(std::string message);

}  // namespace aeroloom::cases
