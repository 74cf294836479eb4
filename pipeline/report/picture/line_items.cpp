#include "pipeline/report/picture/line_items.hpp"

#include "geometry/disjoint_sets.hpp"
#include "geometry/sort_unique.hpp"

#include <algorithm>
#include <map>

namespace aeroloom::picture {

using mesh::GlobalIndex;

std::vector<SurfaceLine> gather_lines(const parallel::Communicator& communicator,
                                      const std::vector<LineItem>& mine) {
  std::vector<LineItem> items;
  for (const parallel::Bytes& bytes :
       communicator.gather(parallel::to_bytes(std::span<const LineItem>(mine)))) {
    const std::vector<LineItem> arrived = parallel::from_bytes<LineItem>(bytes);
    items.insert(items.end(), arrived.begin(), arrived.end());
  }
  std::sort(items.begin(), items.end(), precedes);
  std::vector<GlobalIndex> numbers;
  for (const LineItem& item : items)
    numbers.insert(numbers.end(), item.vertices.begin(), item.vertices.end());
  geometry::sort_unique(numbers);
  const auto place_of = [&](GlobalIndex number) {
    return static_cast<std::int64_t>(std::lower_bound(numbers.begin(), numbers.end(), number) -
                                     numbers.begin());
  };
  geometry::DisjointSets<std::int64_t> sets(numbers.size());
  for (const LineItem& item : items) {
    sets.unite(place_of(item.vertices[0]), place_of(item.vertices[1]));
    sets.unite(place_of(item.vertices[0]), place_of(item.vertices[2]));
  }
  std::map<std::int64_t, SurfaceLine> lines;
  for (const LineItem& item : items) {
    SurfaceLine& line = lines[sets.root(place_of(item.vertices[0]))];
    line.items.push_back(item);
    line.box.add(item.point);
  }
  std::vector<SurfaceLine> result;
  result.reserve(lines.size());
  for (auto& [root, line] : lines) result.push_back(std::move(line));
  return result;
}

LineItem smoothed(const SurfaceLine& line, const LineItem& item) {
  LineItem mean = item;
  mean.normal = mean.along = {};
  double weight = 0, size = 0;
  for (const LineItem& other : line.items) {
    constexpr double around = 4,
                     least_cosine = 0.3;  // elements; of normals: of the other side of a thin edge is less
    if (distance(other.point, item.point) > around * item.size ||
        dot(other.normal, item.normal) < least_cosine)
      continue;
    mean.normal += other.length * other.normal;
    mean.along += (dot(other.along, item.along) < 0 ? -other.length : other.length) * other.along;
    size += other.length * other.size;
    weight += other.length;
  }
  mean.normal = normalized(mean.normal);
  mean.along = normalized(mean.along - dot(mean.along, mean.normal) * mean.normal);
  if (weight > 0) mean.size = size / weight;
  return mean;
}

}  // namespace aeroloom::picture
