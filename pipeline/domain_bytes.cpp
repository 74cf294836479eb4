#include "pipeline/domain_bytes.hpp"

namespace aeroloom::pipeline {

using cad::Change;
using parallel::Packer;
using parallel::Unpacker;

namespace {

void pack_change(const Change& change, Packer& packer) {
  packer.text(change.what);
  packer.value(std::uint8_t{change.where.has_value()});
  packer.value(change.where.value_or(geometry::Vec3{}));
  packer.value(change.how_much);
}

Change unpack_change(Unpacker& unpacker) {
  Change change;
  change.what = unpacker.text();
  const bool placed = unpacker.value<std::uint8_t>() != 0;
  const auto where = unpacker.value<geometry::Vec3>();
  if (placed) change.where = where;
  change.how_much = unpacker.value<double>();
  return change;
}

}  // namespace

void pack_changes(const cad::Changes& changes, Packer& packer) {
  packer.value(static_cast<std::uint64_t>(changes.size()));
  for (const Change& change : changes) pack_change(change, packer);
}

cad::Changes unpack_changes(Unpacker& unpacker) {
  cad::Changes changes(unpacker.value<std::uint64_t>());
  for (Change& change : changes) change = unpack_change(unpacker);
  return changes;
}

void pack_domain(const cad::Domain& domain, Packer& packer) {
  packer.value(domain.report.kind);
  packer.text(domain.report.reason);
  packer.value(domain.report.reference_length);
  pack_changes(domain.report.changes, packer);
  packer.array(domain.model.serialise());
}

cad::Domain unpack_domain(Unpacker& unpacker) {
  cad::DomainReport report;
  report.kind = unpacker.value<cad::DomainKind>();
  report.reason = unpacker.text();
  report.reference_length = unpacker.value<double>();
  report.changes = unpack_changes(unpacker);
  return {cad::Model::from_bytes(unpacker.array<std::byte>()), std::move(report)};
}

}  // namespace aeroloom::pipeline
