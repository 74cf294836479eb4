/// Small vectors of the plane and of space: plain data, value semantics, no allocation.
#pragma once

#include <algorithm>
#include <cmath>

namespace aeroloom::geometry {

/// A point or direction of the plane.
struct Vec2 {
  double x = 0, y = 0;

  Vec2& operator+=(Vec2 b) {
    x += b.x, y += b.y;
    return *this;
  }
  Vec2& operator-=(Vec2 b) {
    x -= b.x, y -= b.y;
    return *this;
  }
  Vec2& operator*=(double s) {
    x *= s, y *= s;
    return *this;
  }
  friend Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
  friend Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
  friend Vec2 operator-(Vec2 a) { return {-a.x, -a.y}; }
  friend Vec2 operator*(double s, Vec2 a) { return {s * a.x, s * a.y}; }
  friend Vec2 operator*(Vec2 a, double s) { return {s * a.x, s * a.y}; }
  friend Vec2 operator/(Vec2 a, double s) { return {a.x / s, a.y / s}; }
  friend bool operator==(Vec2, Vec2) = default;
};

inline double dot(Vec2 a, Vec2 b) {
  return a.x * b.x + a.y * b.y;
}
inline double cross(Vec2 a, Vec2 b) {
  return a.x * b.y - a.y * b.x;
}
inline double norm(Vec2 a) {
  return std::sqrt(dot(a, a));
}
inline double distance(Vec2 a, Vec2 b) {
  return norm(a - b);
}

/// A point or direction of space.
struct Vec3 {
  double x = 0, y = 0, z = 0;

  Vec3& operator+=(Vec3 b) {
    x += b.x, y += b.y, z += b.z;
    return *this;
  }
  Vec3& operator-=(Vec3 b) {
    x -= b.x, y -= b.y, z -= b.z;
    return *this;
  }
  Vec3& operator*=(double s) {
    x *= s, y *= s, z *= s;
    return *this;
  }
  double operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  double& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  friend Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
  friend Vec3 operator*(double s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
  friend Vec3 operator*(Vec3 a, double s) { return {s * a.x, s * a.y, s * a.z}; }
  friend Vec3 operator/(Vec3 a, double s) { return {a.x / s, a.y / s, a.z / s}; }
  friend bool operator==(Vec3, Vec3) = default;
};

inline double dot(Vec3 a, Vec3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double norm(Vec3 a) {
  return std::sqrt(dot(a, a));
}
inline double distance(Vec3 a, Vec3 b) {
  return norm(a - b);
}
/// The unit vector along a; the zero vector stays zero.
inline Vec3 normalized(Vec3 a) {
  const double length = norm(a);
  return length > 0 ? a / length : Vec3{};
}
/// Six times the signed volume of (a,b,c,d), in floating point: positive when d lies on the side of
/// triangle (a,b,c) that its counter-clockwise normal points to.
inline double volume6(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  return dot(cross(b - a, c - a), d - a);
}

/// An axis-aligned box; empty until something is added.
struct Box {
  Vec3 low{1e300, 1e300, 1e300};
  Vec3 high{-1e300, -1e300, -1e300};

  bool empty() const { return low.x > high.x; }
  void add(Vec3 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  void add(const Box& b) {
    if (!b.empty()) add(b.low), add(b.high);
  }
  Vec3 center() const { return 0.5 * (low + high); }
  Vec3 size() const { return high - low; }
  double diagonal() const { return empty() ? 0.0 : distance(low, high); }
  Box dilated(double by) const { return {low - Vec3{by, by, by}, high + Vec3{by, by, by}}; }
  bool contains(Vec3 p) const {
    return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y && p.z >= low.z && p.z <= high.z;
  }
  bool contains(const Box& b) const { return contains(b.low) && contains(b.high); }
  bool overlaps(const Box& b) const {
    return low.x <= b.high.x && b.low.x <= high.x && low.y <= b.high.y && b.low.y <= high.y &&
           low.z <= b.high.z && b.low.z <= high.z;
  }
};

}  // namespace aeroloom::geometry
