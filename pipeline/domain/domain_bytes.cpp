#include "pipeline/domain/domain_bytes.hpp"

#include <tuple>
#include <utility>

namespace aeroloom::domain {

using parallel::Bytes;

Bytes pack_domain(const cad::Domain& domain) {
  return parallel::to_wire(std::forward_as_tuple(domain.report, domain.model.serialise()));
}

cad::Domain unpack_domain(std::span<const std::byte> bytes) {
  auto [report, model] = parallel::from_wire<std::tuple<cad::DomainReport, Bytes>>(bytes);
  return {cad::Model::from_bytes(model), std::move(report)};
}

}  // namespace aeroloom::domain
