/// A driver of HDF5 whose files are MemoryImages. Included by io/hdf5/*.cpp alone: it names HDF5.
#pragma once

#include "io/hdf5/handle.hpp"
#include "io/hdf5/memory_image.hpp"

namespace aeroloom::io::hdf5 {

/// Files made with these access properties go to `image`, which must outlive them. Throws as require().
void use_memory_driver(hid_t access, MemoryImage& image);

}  // namespace aeroloom::io::hdf5
