/// Small faceted shapes and their files, for tests.
#pragma once

#include "cad/faceted/facet_soup.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::cad::faceted {

using geometry::Vec3;

inline FacetSoup empty_soup() {
  FacetSoup soup;
  soup.file = "test.stl";
  soup.format = "test";
  soup.groups.emplace_back();
  return soup;
}

inline void add_triangle(FacetSoup& soup, std::int32_t a, std::int32_t b, std::int32_t c) {
  soup.triangles.push_back({a, b, c});
  soup.group_of.push_back(static_cast<std::int32_t>(soup.groups.size()) - 1);
}

/// The box between two corners, two triangles to a side, normals outwards or, with `inwards`, inwards.
inline void add_box(FacetSoup& soup, Vec3 low, Vec3 high, bool inwards = false) {
  const auto base = static_cast<std::int32_t>(soup.points.size());
  for (int i = 0; i < 8; ++i)
    soup.points.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
  constexpr int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                               {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& q : quads) {
    const int b = inwards ? 2 : 1, d = inwards ? 1 : 2;
    add_triangle(soup, base + q[0], base + q[b], base + q[d]);
    add_triangle(soup, base + q[0], base + q[inwards ? 3 : 2], base + q[inwards ? 2 : 3]);
  }
}

inline FacetSoup box_soup(Vec3 low, Vec3 high) {
  FacetSoup soup = empty_soup();
  add_box(soup, low, high);
  return soup;
}

/// A prism over a regular polygon of the given number of corners, radius 1, from z = 0 to `height`, with
/// `layers` of quads along it.
inline FacetSoup cylinder_soup(int corners, int layers, double height) {
  FacetSoup soup = empty_soup();
  for (int k = 0; k <= layers; ++k) {
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * std::numbers::pi * i / corners;
      soup.points.push_back({std::cos(angle), std::sin(angle), height * k / layers});
    }
  }
  const auto at = [&](int k, int i) { return k * corners + i % corners; };
  for (int k = 0; k < layers; ++k) {
    for (int i = 0; i < corners; ++i) {
      add_triangle(soup, at(k, i), at(k, i + 1), at(k + 1, i + 1));
      add_triangle(soup, at(k, i), at(k + 1, i + 1), at(k + 1, i));
    }
  }
  const auto bottom = static_cast<std::int32_t>(soup.points.size());
  soup.points.push_back({0, 0, 0});
  soup.points.push_back({0, 0, height});
  for (int i = 0; i < corners; ++i) {
    add_triangle(soup, bottom, at(0, i + 1), at(0, i));
    add_triangle(soup, bottom + 1, at(layers, i), at(layers, i + 1));
  }
  return soup;
}

/// A ball of `rows` rows of quads from pole to pole, 2 `rows` to a row, poles on z.
inline FacetSoup ball_soup(Vec3 center, double radius, int rows) {
  FacetSoup soup = empty_soup();
  const int around = 2 * rows;
  for (int k = 1; k < rows; ++k) {
    for (int i = 0; i < around; ++i) {
      const double a = 2 * std::numbers::pi * i / around, b = std::numbers::pi * k / rows;
      soup.points.push_back(
          center + radius * Vec3{std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), -std::cos(b)});
    }
  }
  const auto at = [&](int k, int i) { return (k - 1) * around + i % around; };
  const auto south = static_cast<std::int32_t>(soup.points.size());
  soup.points.push_back(center - Vec3{0, 0, radius});
  soup.points.push_back(center + Vec3{0, 0, radius});
  for (int i = 0; i < around; ++i) {
    add_triangle(soup, south, at(1, i + 1), at(1, i));
    add_triangle(soup, south + 1, at(rows - 1, i), at(rows - 1, i + 1));
    for (int k = 1; k + 1 < rows; ++k) {
      add_triangle(soup, at(k, i), at(k, i + 1), at(k + 1, i + 1));
      add_triangle(soup, at(k, i), at(k + 1, i + 1), at(k + 1, i));
    }
  }
  return soup;
}

/// What the triangles enclose; normals outwards.
inline double volume_of(const FacetSoup& soup) {
  double volume = 0;
  for (const auto& [a, b, c] : soup.triangles)
    volume += dot(soup.points[a], cross(soup.points[b], soup.points[c])) / 6;
  return volume;
}

/// As many programs write it: corners of each triangle on their own.
inline std::string ascii_stl(const FacetSoup& soup, const std::string& name = "body") {
  std::string text = "solid " + name + "\n";
  for (const auto& triangle : soup.triangles) {
    text += " facet normal 0 0 0\n  outer loop\n";
    for (const std::int32_t p : triangle)
      text += fmt::format("   vertex {:.9e} {:.9e} {:.9e}\n", soup.points[p].x, soup.points[p].y,
                          soup.points[p].z);
    text += "  endloop\n endfacet\n";
  }
  return text + "endsolid " + name + "\n";
}

template <class Value>
void append_bytes(std::string& bytes, Value value, bool big = false) {
  char raw[sizeof(Value)];
  std::memcpy(raw, &value, sizeof(Value));
  if (big == (std::endian::native == std::endian::little)) std::reverse(raw, raw + sizeof(Value));
  bytes.append(raw, sizeof(Value));
}

inline std::string binary_stl(const FacetSoup& soup, const std::string& head = "solid but binary") {
  std::string bytes = head;
  bytes.resize(80, ' ');
  append_bytes(bytes, static_cast<std::uint32_t>(soup.triangles.size()));
  for (const auto& triangle : soup.triangles) {
    for (int i = 0; i < 3; ++i) append_bytes(bytes, 0.0F);
    for (const std::int32_t p : triangle) {
      for (int axis = 0; axis < 3; ++axis) append_bytes(bytes, static_cast<float>(soup.points[p][axis]));
    }
    append_bytes(bytes, std::uint16_t{0});
  }
  return bytes;
}

inline std::string off_text(const FacetSoup& soup) {
  std::string text = fmt::format("OFF\n{} {} 0\n", soup.points.size(), soup.triangles.size());
  for (const Vec3 p : soup.points) text += fmt::format("{} {} {}\n", p.x, p.y, p.z);
  for (const auto& [a, b, c] : soup.triangles) text += fmt::format("3 {} {} {}\n", a, b, c);
  return text;
}

inline std::string obj_text(const FacetSoup& soup) {
  std::string text;
  for (const Vec3 p : soup.points) text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
  for (const auto& [a, b, c] : soup.triangles) text += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
  return text;
}

inline std::string ply_bytes(const FacetSoup& soup, bool big) {
  std::string bytes = fmt::format(
      "ply\nformat binary_{}_endian 1.0\ncomment made by a test\nelement vertex {}\nproperty double x\n"
      "property double y\nproperty double z\nproperty uchar red\nelement face {}\n"
      "property list uchar int vertex_indices\nend_header\n",
      big ? "big" : "little", soup.points.size(), soup.triangles.size());
  for (const Vec3 p : soup.points) {
    for (int axis = 0; axis < 3; ++axis) append_bytes(bytes, p[axis], big);
    append_bytes(bytes, std::uint8_t{7}, big);
  }
  for (const auto& triangle : soup.triangles) {
    append_bytes(bytes, std::uint8_t{3}, big);
    for (const std::int32_t p : triangle) append_bytes(bytes, p, big);
  }
  return bytes;
}

inline std::string ply_text(const FacetSoup& soup) {
  std::string text = fmt::format(
      "ply\r\nformat ascii 1.0\r\nelement vertex {}\r\nproperty float x\r\nproperty float y\r\nproperty "
      "float "
      "z\r\nelement face {}\r\nproperty list uchar int vertex_index\r\nend_header\r\n",
      soup.points.size(), soup.triangles.size());
  for (const Vec3 p : soup.points) text += fmt::format("{} {} {}\r\n", p.x, p.y, p.z);
  for (const auto& [a, b, c] : soup.triangles) text += fmt::format("3 {} {} {}\r\n", a, b, c);
  return text;
}

/// The unit cube with a square tunnel's mouths on two sides, a loose segment in another and a partition: what
/// only .poly says.
inline std::string poly_text() {
  return "# a cube of 2 with a partition at z = 1, and a square inside its top\n"
         "16 3 0 1\n"
         "1 0 0 0\n2 2 0 0\n3 2 2 0\n4 0 2 0\n5 0 0 1\n6 2 0 1\n7 2 2 1\n8 0 2 1\n9 0 0 2\n10 2 0 2\n11 2 2 "
         "2\n12 0 2 2\n"
         "13 .5 .5 2\n14 1.5 .5 2\n15 1.5 1.5 2\n16 .5 1.5 2\n"
         "11 1\n"
         "1 0 1\n4 1 2 3 4\n"
         "1 0 2\n4 5 6 7 8\n"
         "2 0 3\n4 9 10 11 12\n4 13 14 15 16\n"
         "1 0 0\n4 1 2 6 5\n1 0 0\n4 2 3 7 6\n1 0 0\n4 3 4 8 7\n1 0 0\n4 4 1 5 8\n"
         "1 0 0\n4 5 6 10 9\n1 0 0\n4 6 7 11 10\n1 0 0\n4 7 8 12 11\n1 0 0\n4 8 5 9 12\n"
         "0\n"
         "2\n1 1 1 .5 10 -1\n2 1 1 1.5 20 -1\n";
}

}  // namespace aeroloom::cad::faceted
