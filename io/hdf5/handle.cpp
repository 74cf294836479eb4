#include "io/hdf5/handle.hpp"

namespace aeroloom::io::hdf5 {

namespace {

/// Takes the first, which is the innermost, failure of a walk up the stack.
herr_t keep_first(unsigned position, const H5E_error2_t* error, void* text) {
  if (position == 0 && error->desc != nullptr) *static_cast<std::string*>(text) = error->desc;
  return 0;
}

}  // namespace

std::string last_reason() {
  std::string reason = "no reason given";
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first, &reason);
  return reason;
}

void open_library() {
  require(H5open(), "cannot start HDF5");
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

}  // namespace aeroloom::io::hdf5
