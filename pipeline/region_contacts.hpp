/// Which CAD entities touch more than one region: vertices there are shared by volume pieces.
#pragma once

#include "geometry/model.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::pipeline {

class RegionContacts {
public:
  explicit RegionContacts(const geometry::Model& model);

  /// Whether more than one region touches the entity (dimension 0 vertex, 1 edge, 2 face).
  bool shared(std::int8_t dimension, std::int32_t entity) const;

private:
  struct Contact {
    geometry::RegionId first = geometry::no_entity;
    bool several = false;
  };

  static void touch(Contact& contact, geometry::RegionId region);

  std::vector<Contact> _vertices, _edges;
  std::vector<char> _faces;
};

}  // namespace aeroloom::pipeline
