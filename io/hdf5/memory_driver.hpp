/// An HDF5 file driver that keeps files in memory, as MemoryImage. Only io/hdf5/*.cpp include this header.
#pragma once

#include "io/hdf5/handle.hpp"
#include "io/hdf5/memory_image.hpp"

namespace aeroloom::io::hdf5 {

/// Files created with these access properties go to `image`, which must outlive them. Throws as require().
void use_memory_driver(hid_t access, MemoryImage& image);

}  // namespace aeroloom::io::hdf5
