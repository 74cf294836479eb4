#include "cad/domain/removed_names.hpp"

#include "cad/model/shape_map.hpp"

#include <unordered_map>
#include <unordered_set>

namespace aeroloom::cad {
namespace {

/// The first change that has each text in quotation marks.
std::unordered_map<std::string, std::string> changes_by_name(const Changes& changes) {
  std::unordered_map<std::string, std::string> by_name;
  for (const Change& change : changes) {
    std::size_t begin = change.what.find('\'');
    while (begin != std::string::npos) {
      const std::size_t end = change.what.find('\'', begin + 1);
      if (end == std::string::npos) break;
      by_name.try_emplace(change.what.substr(begin + 1, end - begin - 1), change.what);
      begin = end;
    }
  }
  return by_name;
}

}  // namespace

std::vector<std::string> names_of_file(const NamedShape& named) {
  std::vector<std::string> names;
  std::unordered_set<std::string> known;
  const TopTools_IndexedMapOfShape faces = map_of(named.shape, TopAbs_FACE);
  for (int i = 1; i <= faces.Extent(); ++i) {
    const FaceLabel* label = named.labels.Seek(faces(i));
    if (label == nullptr) continue;
    for (const std::string& name : {shown_name(*label), label->solid, label->layer})
      if (!name.empty() && known.insert(name).second) names.push_back(name);
  }
  return names;
}

std::vector<RemovedName> find_removed_names(const std::vector<std::string>& names, const Model& model,
                                            const Changes& changes) {
  std::unordered_set<std::string> left(model.patches().begin(), model.patches().end());
  for (FaceId f = 0; f < model.face_count(); ++f)
    for (const std::string& name : {model.face(f).name, model.face(f).part, model.face(f).layer})
      left.insert(name);
  const std::unordered_map<std::string, std::string> by_name = changes_by_name(changes);
  std::vector<RemovedName> removed;
  for (const std::string& name : names) {
    if (left.contains(name)) continue;
    const auto change = by_name.find(name);
    removed.push_back({name, change != by_name.end()
                                 ? change->second
                                 : "its faces do not bound the domain, or were joined with others"});
  }
  return removed;
}

}  // namespace aeroloom::cad
