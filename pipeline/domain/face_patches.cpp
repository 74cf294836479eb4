#include "pipeline/domain/face_patches.hpp"

#include "parallel/communication/collective_error.hpp"
#include "parallel/communication/packer.hpp"
#include "parallel/observation/timers.hpp"

#include <stdexcept>
#include <string>
#include <tuple>

namespace aeroloom::domain {

cases::TypedPatches find_patches(const parallel::Communicator& communicator, const cad::Model& model,
                                 const cases::Case& input) {
  if (input.groups.rules.empty() && !input.groups.strict && input.patches.empty())
    return cases::apply_patch_rules(model, {});
  std::string refused;
  cases::FacePatches chosen;
  parallel::Bytes bytes;
  parallel::on_root(communicator, [&] {
    const parallel::ScopedCpu cpu(parallel::ScopedCpu::As::serial);
    try {
      chosen = cases::choose_patches(model, input.groups, input.patches);
    } catch (const std::invalid_argument& error) {
      refused = error.what();  // a fault of the case, and not of the program
    }
    bytes = parallel::to_wire(std::tie(refused, chosen.patch_of_face, chosen.taken));
  });
  communicator.broadcast(bytes);
  auto all = std::tie(refused, chosen.patch_of_face, chosen.taken);
  parallel::from_wire_into(bytes, all);
  if (!refused.empty()) throw std::invalid_argument(refused);
  return cases::apply_patches(model, chosen, input.groups, input.patches);
}

}  // namespace aeroloom::domain
