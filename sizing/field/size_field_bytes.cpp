#include "sizing/field/size_field.hpp"

#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

namespace aeroloom::sizing {

/// All but what follows from the leaves.
template <class Field>
auto SizeField::fields_of(Field& field) {
  return std::tie(field._options, field._domain, field._low, field._root_edge, field._factor,
                  field._octree.keys, field._octree.levels);
}

parallel::Bytes SizeField::pack() const {
  return parallel::to_wire(std::tuple_cat(fields_of(*this), std::tie(_corner_sizes.packed())));
}

SizeField SizeField::unpack(const parallel::Communicator& communicator, std::span<const std::byte> bytes) {
  SizeField field;
  parallel::NodeArray<float> corner_sizes;
  auto fields = std::tuple_cat(fields_of(field), std::tie(corner_sizes));
  parallel::from_wire_into(bytes, fields);
  Octree& octree = field._octree;
  if (octree.levels.size() != octree.keys.size())
    throw std::logic_error("SizeField::unpack: arrays of different lengths");
  octree.communicator = communicator;
  field._corner_sizes = CornerSizes::unpacked(octree, std::move(corner_sizes));
  octree.table = LeafTable(octree.leaves());
  octree.share();
  return field;
}

parallel::Digest SizeField::digest() const {
  parallel::Digester digester;
  for (const double number : {_options.minimum, _options.maximum, _options.growth, _root_edge, _factor})
    digester.value(number);
  for (const geometry::Vec3& corner : {_domain.low, _domain.high, _low})
    digester.value(corner.x).value(corner.y).value(corner.z);
  return digester.items(_octree.keys.items())
      .items(_octree.levels.items())
      .items(_corner_sizes.packed().items())
      .result();
}

}  // namespace aeroloom::sizing
