/// Points and CAD changes as JSON.
#pragma once

#include "cad/model/evaluation/face_place.hpp"
#include "cad/repair/change.hpp"

#include <nlohmann/json.hpp>

namespace aeroloom::report {

inline nlohmann::ordered_json to_json(geometry::Vec3 p) {
  return nlohmann::ordered_json::array({p.x, p.y, p.z});
}

inline nlohmann::ordered_json to_json(const geometry::Box& box) {
  return nlohmann::ordered_json::array({to_json(box.low), to_json(box.high)});
}

/// The first members of a JSON object about a face.
inline nlohmann::ordered_json face_row(const std::string& name, const cad::FacePlace& place) {
  return {
      {"name", name}, {"area", place.area}, {"centre", to_json(place.centre)}, {"box", to_json(place.box)}};
}

inline nlohmann::ordered_json to_json(const cad::Changes& changes) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const cad::Change& change : changes) {
    json.push_back({{"what", change.what},
                    {"where", change.where ? to_json(*change.where) : nlohmann::ordered_json()},
                    {"how_much", change.how_much}});
  }
  return json;
}

}  // namespace aeroloom::report
