#include "cad/faceted/close_facets.hpp"
#include "geometry/predicates.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// Keeps the triangles that are marked.
void keep_triangles(FacetSoup& soup, const std::vector<char>& kept) {
  std::size_t count = 0;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    if (kept[t] == 0) continue;
    soup.triangles[count] = soup.triangles[t];
    soup.group_of[count++] = soup.group_of[t];
  }
  soup.triangles.resize(count);
  soup.group_of.resize(count);
}

/// For each triangle whether none before it has the same corners.
std::vector<char> first_of_equals(const FacetSoup& soup) {
  std::vector<std::pair<std::array<std::int32_t, 3>, std::int32_t>> sorted;
  sorted.reserve(soup.triangles.size());
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    auto corners = soup.triangles[t];
    std::sort(corners.begin(), corners.end());
    sorted.emplace_back(corners, static_cast<std::int32_t>(t));
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<char> first(soup.triangles.size(), 1);
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i].first == sorted[i - 1].first) first[sorted[i].second] = 0;
  }
  return first;
}

}  // namespace

void replace_points(FacetSoup& soup, const std::vector<std::int32_t>& representative) {
  std::vector<std::int32_t> number(soup.points.size(), -1);
  for (auto& triangle : soup.triangles) {
    for (std::int32_t& corner : triangle) {
      corner = representative[corner];
      number[corner] = 0;
    }
  }
  std::int32_t count = 0;
  for (std::size_t p = 0; p < number.size(); ++p) {
    if (number[p] < 0) continue;
    number[p] = count;
    soup.points[count++] = soup.points[p];
  }
  soup.points.resize(count);
  for (auto& triangle : soup.triangles) {
    for (std::int32_t& corner : triangle) corner = number[corner];
  }
}

void weld_equal_points(FacetSoup& soup) {
  const Vec3 zero{0, 0, 0};
  for (Vec3& p : soup.points) p += zero;  // -0 becomes 0
  std::vector<std::int32_t> order(soup.points.size()), representative(soup.points.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, [&](std::int32_t a, std::int32_t b) {
    const Vec3 &p = soup.points[a], &q = soup.points[b];
    return std::tie(p.x, p.y, p.z, a) < std::tie(q.x, q.y, q.z, b);
  });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool repeats = i > 0 && soup.points[order[i]] == soup.points[order[i - 1]];
    representative[order[i]] = repeats ? representative[order[i - 1]] : order[i];
  }
  replace_points(soup, representative);
}

bool on_one_line(Vec3 a, Vec3 b, Vec3 c) {
  const auto flat = [&](int i, int j) {
    return geometry::orient2d({a[i], a[j]}, {b[i], b[j]}, {c[i], c[j]}) == 0;
  };
  return flat(0, 1) && flat(1, 2) && flat(2, 0);
}

void drop_flat_triangles(FacetSoup& soup, Changes& changes) {
  std::vector<char> kept;
  std::size_t flat = 0;
  Vec3 flat_at;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const auto [a, b, c] = corners_of(soup, t);
    kept.push_back(on_one_line(a, b, c) ? 0 : 1);
    if (kept.back() == 0 && flat++ == 0) flat_at = middle_of(soup, t);
  }
  if (flat == 0) return;
  keep_triangles(soup, kept);
  changes.push_back({fmt::format("{} triangles without area are left out", flat), flat_at});
}

void drop_void_triangles(FacetSoup& soup, Changes& changes) {
  std::vector<char> kept = first_of_equals(soup);
  std::size_t repeated = 0, thin = 0;
  Vec3 repeated_at, thin_at;
  for (std::size_t t = 0; t < kept.size(); ++t) {
    const auto [a, b, c] = corners_of(soup, t);
    if (on_one_line(a, b, c)) {
      kept[t] = 0;
      if (thin++ == 0) thin_at = middle_of(soup, t);
    } else if (kept[t] == 0 && repeated++ == 0) {
      repeated_at = middle_of(soup, t);
    }
  }
  keep_triangles(soup, kept);
  if (thin > 0) changes.push_back({fmt::format("{} triangles without area are left out", thin), thin_at});
  if (repeated > 0)
    changes.push_back({fmt::format("{} triangles that others repeat are left out", repeated), repeated_at});
}

}  // namespace aeroloom::cad
