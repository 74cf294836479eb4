#include "sizing/size_field.hpp"

#include <stdexcept>
#include <utility>

namespace aeroloom::sizing {
namespace {

template <class T>
std::vector<T> copy_of(const parallel::NodeArray<T>& array) {
  return {array.items().begin(), array.items().end()};
}

}  // namespace

parallel::Bytes SizeField::pack() const {
  parallel::Packer packer;
  packer.value(_options);
  packer.value(_domain);
  packer.value(_low);
  packer.value(_root_edge);
  packer.value(_factor);
  packer.array(copy_of(_leaf_keys));
  packer.array(copy_of(_leaf_levels));
  packer.array(copy_of(_corner_sizes));
  return packer.take();
}

SizeField SizeField::unpack(const parallel::Communicator& communicator, std::span<const std::byte> bytes) {
  parallel::Unpacker unpacker(bytes);
  SizeField field;
  field._options = unpacker.value<SizingOptions>();
  field._domain = unpacker.value<geometry::Box>();
  field._low = unpacker.value<geometry::Vec3>();
  field._root_edge = unpacker.value<double>();
  field._factor = unpacker.value<double>();
  SplitCubes::Leaves leaves;
  leaves.keys = unpacker.array<std::uint64_t>();
  leaves.levels = unpacker.array<std::uint8_t>();
  std::vector<float> corner_sizes = unpacker.array<float>();
  if (leaves.levels.size() != leaves.keys.size() || corner_sizes.size() != 8 * leaves.keys.size())
    throw std::logic_error("SizeField::unpack: arrays of different lengths");
  field._leaf_table = LeafTable(leaves).shared(communicator);
  field._corner_sizes = {communicator, std::move(corner_sizes)};
  field._leaf_keys = {communicator, std::move(leaves.keys)};
  field._leaf_levels = {communicator, std::move(leaves.levels)};
  return field;
}

parallel::Digest SizeField::digest() const {
  parallel::Digester digester;
  for (const double number : {_options.minimum, _options.maximum, _options.growth, _root_edge, _factor})
    digester.value(number);
  for (const geometry::Vec3& corner : {_domain.low, _domain.high, _low})
    digester.value(corner.x).value(corner.y).value(corner.z);
  return digester.items(_leaf_keys.items()).items(_leaf_levels.items()).items(_corner_sizes.items()).result();
}

}  // namespace aeroloom::sizing
