/// The side of InputFile that runs in a child and sees HDF5. Internal to io/hdf5/.
#pragma once

#include <cstdint>
#include <string>

namespace aeroloom::io::hdf5 {

enum class Operation : std::uint8_t { survey, integers, reals, texts };

/// The name of the contained task, which is known before main() begins.
const std::string& reading_task();

}  // namespace aeroloom::io::hdf5
