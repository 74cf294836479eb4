#include "sizing/field/size_field.hpp"

#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

namespace aeroloom::sizing {
namespace {

template <class T>
std::vector<T> copy_of(const parallel::NodeArray<T>& array) {
  return {array.items().begin(), array.items().end()};
}

}  // namespace

/// All but what follows from the leaves.
template <class Field>
auto SizeField::fields_of(Field& field) {
  return std::tie(field._options, field._domain, field._low, field._root_edge, field._factor,
                  field._leaf_keys, field._leaf_levels);
}

parallel::Bytes SizeField::pack() const {
  return parallel::to_wire(std::tuple_cat(fields_of(*this), std::tie(_corner_sizes.packed())));
}

SizeField SizeField::unpack(const parallel::Communicator& communicator, std::span<const std::byte> bytes) {
  SizeField field;
  parallel::NodeArray<float> corner_sizes;
  auto fields = std::tuple_cat(fields_of(field), std::tie(corner_sizes));
  parallel::from_wire_into(bytes, fields);
  const std::size_t leaves = field._leaf_keys.size();
  if (field._leaf_levels.size() != leaves)
    throw std::logic_error("SizeField::unpack: arrays of different lengths");
  field._corner_sizes = CornerSizes::unpacked(communicator, field.leaves(), std::move(corner_sizes));
  field._leaf_table =
      LeafTable({copy_of(field._leaf_keys), copy_of(field._leaf_levels)}).shared(communicator);
  field._leaf_keys = field._leaf_keys.shared(communicator);
  field._leaf_levels = field._leaf_levels.shared(communicator);
  return field;
}

parallel::Digest SizeField::digest() const {
  parallel::Digester digester;
  for (const double number : {_options.minimum, _options.maximum, _options.growth, _root_edge, _factor})
    digester.value(number);
  for (const geometry::Vec3& corner : {_domain.low, _domain.high, _low})
    digester.value(corner.x).value(corner.y).value(corner.z);
  return digester.items(_leaf_keys.items())
      .items(_leaf_levels.items())
      .items(_corner_sizes.packed().items())
      .result();
}

}  // namespace aeroloom::sizing
