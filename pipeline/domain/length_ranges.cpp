#include "pipeline/domain/length_ranges.hpp"

#include "parallel/communication/packer.hpp"
#include "pipeline/case/given_lengths.hpp"

#include <stdexcept>
#include <string>

namespace aeroloom::domain {

void require_lengths_of_model(const parallel::Communicator& communicator, const cad::Model& model,
                              const cases::Case& input) {
  std::string fault;
  if (communicator.is_root()) fault = cases::fault_of_lengths(input.lengths, model.body_bounds());
  parallel::Bytes bytes = parallel::to_wire(fault);
  communicator.broadcast(bytes);
  fault = parallel::from_wire<std::string>(bytes);
  if (!fault.empty()) throw std::invalid_argument(fault);
}

}  // namespace aeroloom::domain
