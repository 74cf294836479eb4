#include "cad/domain/mixed_bodies.hpp"

#include "cad/faceted/facet_contacts.hpp"
#include "cad/faceted/facet_meeting.hpp"
#include "cad/faceted/facet_walls.hpp"
#include "cad/faceted/faceted_domain.hpp"
#include "cad/faceted/make_facet_complex.hpp"
#include "cad/faceted/shape_facets.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/model/step_trace.hpp"
#include "cad/repair/heal.hpp"
#include "cad/tolerances.hpp"
#include "geometry/angle.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

// Chosen, not measured: triangles of bodies that are united lie a tenth of the smallest size off their faces,
// or a ten-thousandth of the body where no size is known, and turn by twelve degrees at most.
constexpr double deflection_over_size = 0.1, deflection_over_diagonal = 1e-4;
/// Of the diagonal, however small sizes are: the built-in aircraft has 100,000 triangles then.
constexpr double least_deflection = 5e-5;
constexpr double most_facet_angle = 12 * geometry::degree;
/// Where bodies come near each other, triangles are made as much finer in turn.
constexpr double finer[] = {1, 0.25, 0.0625};

void append_soup(FacetSoup& all, const FacetSoup& more) {
  const auto points = static_cast<std::int32_t>(all.points.size()),
             groups = static_cast<std::int32_t>(all.groups.size());
  all.points.insert(all.points.end(), more.points.begin(), more.points.end());
  all.groups.insert(all.groups.end(), more.groups.begin(), more.groups.end());
  for (std::size_t t = 0; t < more.triangles.size(); ++t) {
    const auto& [a, b, c] = more.triangles[t];
    all.triangles.push_back({a + points, b + points, c + points});
    all.group_of.push_back(more.group_of[t] + groups);
  }
}

std::string name_of_soup(const FacetSoup& soup) {
  const FacetSoup::Group& group = soup.groups[soup.group_of.front()];
  return group.part.empty() ? group.name : group.part;
}

/// Bodies that stay CAD and bodies that are triangles, none of which overlap in the end.
class BodyMixer {
public:
  BodyMixer(const NamedShape& bodies, const DomainOptions& options, Changes& changes)
      : _labels(bodies.labels), _options(options), _changes(changes) {
    if (bodies.shape.IsNull()) return;
    for (const TopoDS_Solid& solid : solids_of(bodies.shape))
      _solids.push_back({solid, tight_box(solid), {}});
  }

  void add(FacetSoup soup) { _facets.push_back(std::move(soup)); }

  /// As triangles: each meets another, or stays clear of it.
  void add_refused(const RefusedUnion& refused) {
    std::vector<CadBody> bodies;
    for (const TopoDS_Solid& solid : refused.solids) bodies.push_back({solid, tight_box(solid), {}});
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const MeetingPlace found = meet(bodies[i], [&](double fraction) -> const FacetSoup& {
          return triangulate(bodies[j], fraction).soup;
        });
        if (found.meeting != FacetMeeting::near) continue;
        throw CadError(fmt::format("{}; nor do their triangles tell whether they touch near {}",
                                   refused.reason, place_in_file(found.at)));
      }
    }
    for (CadBody& body : bodies) take(body, refused.reason);
  }

  /// CAD bodies that overlap triangles become triangles, until none does.
  void absorb() {
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t i = 0; i < _solids.size(); ++i) {
        const std::optional<std::string> other = overlapped_by(_solids[i]);
        if (!other) continue;
        take(_solids[i], fmt::format("it overlaps '{}'", *other));
        _solids.erase(_solids.begin() + static_cast<std::ptrdiff_t>(i));
        changed = true;
        break;
      }
    }
  }

  /// What lies inside a body of the other kind does not reach the fluid.
  void drop_buried() {
    const auto is_buried = [&](const FacetSoup& soup) {
      return std::ranges::any_of(_solids, [&](CadBody& body) {
        return !body.facets.soup.triangles.empty() && encloses(body.facets.soup, soup.points.front());
      });
    };
    const std::size_t facets = std::erase_if(_facets, is_buried);
    const std::size_t solids = std::erase_if(_solids, [&](const CadBody& body) {
      return std::ranges::any_of(_facets, [&](const FacetSoup& soup) {
        return !body.facets.soup.triangles.empty() && encloses(soup, body.facets.soup.points.front());
      });
    });
    if (facets + solids == 0) return;
    _changes.push_back(
        {fmt::format("{} bodies lie inside others and do not reach the fluid: left out", facets + solids)});
  }

  std::vector<TopoDS_Solid> solids() const {
    std::vector<TopoDS_Solid> solids;
    for (const CadBody& body : _solids) solids.push_back(body.solid);
    return solids;
  }
  FacetSoup facets() const {
    FacetSoup all;
    for (const FacetSoup& soup : _facets) append_soup(all, soup);
    return all;
  }
  bool any_taken() const { return _any_taken; }

private:
  struct CadBody {
    TopoDS_Solid solid;
    Box box;
    ShapeFacets facets;
    double fraction = 0;  ///< of the limits that the facets were made with; 0: not made
  };

  double deflection(const CadBody& body) const {
    const double diagonal = body.box.diagonal();
    if (_options.smallest_size == 0) return deflection_over_diagonal * diagonal;
    return std::max(deflection_over_size * _options.smallest_size, least_deflection * diagonal);
  }

  const ShapeFacets& triangulate(CadBody& body, double fraction) {
    if (body.fraction == 0 || body.fraction > fraction) {
      body.facets = facets_of(body.solid, _labels, {fraction * deflection(body), most_facet_angle});
      body.fraction = fraction;
    }
    return body.facets;
  }

  /// Of a CAD body and triangles: finer ones as long as they are near each other without crossing.
  template <class Other>
  MeetingPlace meet(CadBody& body, const Other& other) {
    MeetingPlace found;
    for (const double fraction : finer) {
      const FacetSoup& soup = other(fraction);
      const ShapeFacets& own = triangulate(body, fraction);
      found = find_meeting(own.soup, soup, 2 * std::max(own.deviation, fraction * deflection(body)));
      if (found.meeting != FacetMeeting::near) return found;
    }
    return found;
  }

  /// What a CAD body overlaps among the triangles.
  std::optional<std::string> overlapped_by(CadBody& body) {
    for (const FacetSoup& soup : _facets) {
      if (!box_of_points(soup.points).overlaps(body.box.dilated(2 * deflection(body)))) continue;
      const MeetingPlace found = meet(body, [&](double) -> const FacetSoup& { return soup; });
      if (found.meeting == FacetMeeting::crossing) return name_of_soup(soup);
      if (found.meeting == FacetMeeting::apart) continue;
      throw CadError(
          fmt::format("the bodies '{}' and '{}' are so near each other at {} that triangles do not tell "
                      "whether they touch. "
                      "Remedy: move one of them so that they overlap clearly or stay apart",
                      name_of_soup(body.facets.soup), name_of_soup(soup), place_in_file(found.at)));
    }
    return std::nullopt;
  }

  void take(CadBody& body, const std::string& why) {
    const ShapeFacets& facets = triangulate(body, finer[0]);
    _changes.push_back(
        {fmt::format("body '{}' became {} triangles, at most {:.3g} off its faces: {}",
                     name_of_soup(facets.soup), facets.soup.triangles.size(), in_file(facets.deviation), why),
         body.box.center(), facets.deviation, true});
    _facets.push_back(facets.soup);
    _any_taken = true;
  }

  const FaceLabels& _labels;
  const DomainOptions& _options;
  Changes& _changes;
  std::vector<CadBody> _solids;
  std::vector<FacetSoup> _facets;
  bool _any_taken = false;
};

/// Walls of the bodies that are triangles, seen from the fluid; nothing without any.
std::optional<FacetComplex> make_walls(FacetSoup facets, const DomainOptions& options, Changes& changes) {
  if (facets.triangles.empty()) return std::nullopt;
  facets.file = "bodies of triangles";
  for (const FacetedBody& part : options.parts)
    facets.file += fmt::format("{} '{}' of {}", &part == &options.parts.front() ? ", of part" : " and",
                               part.name, part.file);
  const FacetComplex complex = make_facet_complex(std::move(facets), options.feature_angle * geometry::degree,
                                                  changes, CrossingFacets::unite);
  return outer_walls(complex, changes);
}

/// `unit` is that of shapes where the file holds triangles.
void gather_facets(BodyMixer& mixer, const std::vector<RefusedUnion>& refused, std::optional<double> unit,
                   const DomainOptions& options, Changes& changes) {
  report_step("reading the triangles");
  if (unit) mixer.add(read_bodies({"", options.file, 1 / *unit}, options, changes));
  for (const FacetedBody& part : options.parts) mixer.add(read_part(part, options, changes));
  for (const RefusedUnion& each : refused) mixer.add_refused(each);
}

}  // namespace

MixedFluid surround_mixed(NamedShape bodies, const std::vector<RefusedUnion>& refused,
                          const DomainOptions& options, Volumes& volumes, Changes& changes) {
  const FarFieldOptions far_field = options.far_field.value_or(options.default_far_field);
  const bool has_cad = !bodies.shape.IsNull();
  BodyMixer mixer(bodies, options, changes);
  gather_facets(mixer, refused, has_cad ? std::nullopt : std::optional(bodies.unit), options, changes);
  report_step("finding bodies that overlap triangles");
  mixer.absorb();
  mixer.drop_buried();
  MixedFluid fluid;
  std::optional<FacetComplex> walls = make_walls(mixer.facets(), options, changes);
  const std::vector<TopoDS_Solid> solids = mixer.solids();
  if (mixer.any_taken()) refuse_symmetry(far_field, "bodies that are united as triangles");
  if (walls) fluid.walled_volume = -enclosed_volume(*walls);
  if (solids.empty()) {
    refuse_symmetry(far_field, "bodies of triangles");
    fluid.shape = far_field_around(*walls, far_field);
    fluid.shape.unit_name = bodies.unit_name, fluid.shape.unit_in_metres = bodies.unit_in_metres;
    fluid.shape.unit = bodies.unit;
  } else {
    const Box beside = walls ? box_of_points(walls->points) : Box{};
    bodies.shape = make_compound(solids);
    fluid.shape = surround(std::move(bodies), far_field, volumes, changes, beside);
  }
  if (!walls) return fluid;
  fluid.walls.emplace(make_faceted_geometry(*std::move(walls)));
  fluid.wall_tags = tag_walls(fluid.walls->complex(), !has_cad, options, changes);
  return fluid;
}

void require_mixed_volume(const Model& model, const MixedFluid& fluid, Volumes& volumes) {
  const double outer = volumes.of(fluid.shape.shape), found = model.region_volume(0);
  const double body = fluid.walled_volume;
  const double error = std::abs(outer - body - found);
  const bool is_positive = !fluid.walls || body > 0;
  if (is_positive && error <= tolerances::sum_of_volumes * std::abs(body) + tolerances::rounding * outer)
    return;
  throw CadError(fmt::format(
      "the volumes do not add up: without bodies of triangles {:.9g}, these {:.9g}, fluid {:.9g}; "
      "the triangles are turned inside out",
      in_file(outer, 3), in_file(body, 3), in_file(found, 3)));
}

}  // namespace aeroloom::cad
