#include "pipeline/report/cut_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::report {
namespace {

using geometry::Box;
using geometry::Vec3;
using picture::Camera;
using picture::Canvas;
using picture::Place;
using picture::Plane;
using picture::Scene;
using picture::Viewpoint;

constexpr int least_height_of_cut = 360;
/// Elements across a close-up: each is seen as a triangle, and what it belongs to too.
constexpr double elements_across_cut = 36;
/// Of the diagonal: a plane of symmetry is cut just inside, where there are tetrahedra; a middle that is
/// nearer to zero is zero.
constexpr double just_inside = 1e-7, as_good_as_zero = 1e-3;

constexpr Vec3 up{0, 0, 1};

/// Collective.
std::vector<LegendItem> legend_of_cuts(const mesh::DistributedMesh& volume) {
  std::vector<LegendItem> legend;
  legend.reserve(picture::angle_classes.size());
  for (const picture::AngleClass& each : picture::angle_classes) {
    legend.push_back({fmt::format("smallest dihedral angle {}", each.name), html_name(each.colour)});
  }
  const bool layered = std::any_of(volume.pieces.begin(), volume.pieces.end(),
                                   [](const mesh::Piece& piece) { return !piece.layers.empty(); });
  if (volume.communicator.maximum(std::int64_t{layered}) > 0)
    legend.push_back({"boundary layers", html_name(picture::layer_green)});
  return legend;
}

/// A plane and how one looks at it.
struct Cut {
  Plane plane;
  Viewpoint view;
};

/// Looks at a plane so that x goes to the right and z upwards as far as they lie in it.
Cut look_at_plane(Vec3 normal, double offset) {
  const Vec3 upwards = std::abs(normal.z) > 0.9 ? Vec3{0, 1, 0} : up;
  Viewpoint view = picture::look_from(normal, upwards);
  if (view.right.x < -0.1) view = picture::look_from(-normal, upwards);
  return {{normal, offset}, view};
}

Cut main_cut(const Scene& scene) {
  for (const int axis : {1, 2, 0}) {
    const double open = scene.open_towards[axis];
    if (!scene.has_body || std::abs(open) <= half_open) continue;
    // Just inside of the plane that half a body ends at.
    const double end = open > 0 ? scene.box.low[axis] : scene.box.high[axis];
    Vec3 normal;
    normal[axis] = std::copysign(1, open);
    return look_at_plane(normal, normal[axis] * end + just_inside * scene.box.diagonal());
  }
  int axis = 1;
  if (!scene.has_body) {
    const Vec3 size = scene.box.size();
    constexpr double shorter = 0.999;  // by more than rounding, or y is across as on an aircraft
    for (const int other : {2, 0}) axis = size[other] < shorter * size[axis] ? other : axis;
  }
  Vec3 normal;
  normal[axis] = 1;
  const double middle = scene.box.center()[axis];
  return look_at_plane(normal, std::abs(middle) < as_good_as_zero * scene.box.diagonal() ? 0 : middle);
}

Picture painted_cut(const PictureSubject& subject, const mesh::DistributedMesh& volume, const Plane& plane,
                    const Camera& camera, std::string name, std::string caption) {
  if (subject.scene.has_body) caption += " The body is grey.";
  return painted(
      subject,
      {.name = std::move(name),
       .caption = std::move(caption),
       .width = camera.window.width,
       .height = camera.window.height,
       .legend = legend_of_cuts(volume)},
      [&](Canvas& canvas) {
        draw_cut(canvas, camera, volume, plane, 0.8);
        draw_section(canvas, camera, subject.source.surface, subject.scene, plane, 2);
      },
      [&](Canvas& canvas) {
        if (subject.scene.has_body) draw_backdrop(canvas, camera, subject.scene.box, picture::solid_grey);
      });
}

}  // namespace

Picture cut_picture(const PictureSubject& subject, const mesh::DistributedMesh& volume) {
  const Cut cut = main_cut(subject.scene);
  const auto box_in_view = [&](const Box& box) {
    Box seen;
    for (int corner = 0; corner < 8; ++corner) {
      seen.add(in_view(cut.view, {corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                                  corner & 4 ? box.high.z : box.low.z}));
    }
    return seen;
  };
  Box seen = box_in_view(subject.scene.box);
  if (subject.scene.has_body) {
    const Box domain = box_in_view(subject.scene.domain);
    seen = seen.dilated(0.15 * std::max(seen.size().x, seen.size().y));
    for (int axis = 0; axis < 3; ++axis) {
      seen.low[axis] = std::max(seen.low[axis], domain.low[axis]);
      seen.high[axis] = std::min(seen.high[axis], domain.high[axis]);
    }
  }
  const int height = height_for(seen, least_height_of_cut, most_height);
  const double around = subject.scene.has_body ? 0 : picture_margin;
  const Camera camera = picture::frame(cut.view, seen, {0, 0, picture_width, height}, around);
  return painted_cut(subject, volume, cut.plane, camera, "cut",
                     fmt::format("The tetrahedra that a plane cuts, {}.",
                                 subject.scene.has_body ? "around the body" : "from wall to wall"));
}

Picture leading_edge_cut_picture(const PictureSubject& subject, const mesh::DistributedMesh& volume,
                                 const Place& place) {
  const double across = width_around(subject, place, elements_across_cut);
  const Cut cut = look_at_plane(place.along, dot(place.along, place.point));
  const Camera camera = picture::close_up(cut.view, place.point, across, {0, 0, detail_width, detail_height});
  return painted_cut(
      subject, volume, cut.plane, camera, "leading_edge_cut",
      fmt::format("The tetrahedra that a plane across {} cuts; the picture is {} wide.",
                  place.upstream ? "the leading edge" : "the sharpest place", width_text(subject, across)));
}

}  // namespace aeroloom::report
