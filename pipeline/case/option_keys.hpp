/// Replaces names of options by keys of the case in messages.
#pragma once

#include <string>

namespace aeroloom::cases {

/// The message with names such as `VolumeOptions::piece_tets` replaced by the key that sets the option:
/// `volume.piece_tets`. Unknown names stay.
std::string with_keys(std::string message);

}  // namespace aeroloom::cases
