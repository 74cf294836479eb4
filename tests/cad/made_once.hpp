/// A model that takes long to make, on all ranks: rank 0 makes it, and the others have it from its bytes.
#pragma once

#include "cad/model/model.hpp"
#include "parallel/communication/communicator.hpp"

namespace aeroloom::cad {

/// `make()`: the model. Collective.
template <class Make>
Model made_once(const parallel::Communicator& ranks, const Make& make) {
  parallel::Bytes bytes;
  if (ranks.is_root()) bytes = make().serialise();
  ranks.broadcast(bytes);
  return Model::from_bytes(bytes);
}

}  // namespace aeroloom::cad
