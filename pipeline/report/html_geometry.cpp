#include "pipeline/report/html_sections.hpp"
#include "pipeline/report/page/html_table.hpp"

#include <map>

#include <fmt/format.h>

namespace aeroloom::report::html {
namespace {

/// Characters of a cell of a table, whose row is to stay one; report.json has all.
constexpr std::size_t longest_change = 1000, longest_retry = 500;

std::string worst_table(const Json& places) {
  Table table(
      {{"flaw"}, {"value", Align::right}, {"verdict"}, {"shape"}, {"cell", Align::right}, {"centre"}});
  for (const Json& place : places) {
    const std::string flaw = text(find(place, "/flaw")), verdict = escaped(text(find(place, "/verdict")));
    const Json& value = find(place, "/value");
    table.add({flaw == "smallest_angle" ? "smallest dihedral angle"
               : flaw == "size_jump"    ? "largest neighbour over the cell"
                                        : "shape",
               flaw == "smallest_angle" ? degrees(value) : quantity(value), badge(verdict, verdict),
               escaped(text(find(place, "/shape"))), count(find(place, "/cell")),
               html::place(find(place, "/center"))});
  }
  return part("The worst places, of all cells", table.html());
}

std::string names(const Json& list) {
  std::string all;
  for (const Json& item : list) all += (all.empty() ? "" : ", ") + name(item);
  return all;
}

std::string pinned_table(const Json& pinned) {
  Table table({{"what meets"},
               {"of the faces"},
               {"angle of the CAD", Align::right},
               {"smallest dihedral angle", Align::right},
               {"tetrahedra", Align::right},
               {"at"}});
  for (const Json& item : pinned) {
    table.add({text(find(item, "/kind")) == "faces" ? "two faces" : "two curves", names(find(item, "/faces")),
               degrees(find(item, "/angle_deg")), degrees(find(item, "/smallest_dihedral_deg")),
               count(find(item, "/tetrahedra")), place(find(item, "/at"))});
  }
  if (table.empty()) return {};
  return part("Sharp places of the CAD that force small angles",
              paragraph("No mesh is better here; only other CAD is.") + table.html());
}

std::string unresolved_table(const Json& features) {
  Table table({{"what"},
               {"face"},
               {"opposite"},
               {"width", Align::right},
               {"smallest dihedral angle", Align::right},
               {"tetrahedra", Align::right},
               {"at"}});
  for (const Json& item : features) {
    table.add({escaped(text(find(item, "/kind"))), name(find(item, "/face")), name(find(item, "/opposite")),
               quantity(find(item, "/width")), degrees(find(item, "/smallest_dihedral_deg")),
               count(find(item, "/tetrahedra")), place(find(item, "/at"))});
  }
  if (table.empty()) return {};
  return part(
      "Strips and gaps finer than the elements",
      paragraph("Elements there are longer than the walls are apart. Remedies: smaller sizes there, a larger "
                "<code>sizing.feature_budget</code>, or simpler CAD.") +
          table.html());
}

/// Colours of names in the legends of pictures; of patches that stand in several, the first.
std::map<std::string, std::string> colours_of(const std::vector<Picture>& pictures) {
  std::map<std::string, std::string> colours;
  for (const Picture& picture : pictures) {
    for (const LegendItem& item : picture.legend) colours.emplace(as_utf8(item.name), item.colour);
  }
  return colours;
}

std::string deviation(const Json& patch) {
  const double cad = number(find(patch, "/cad_area"));
  return cad > 0 ? percent(number(find(patch, "/area")) / cad - 1) : "–";
}

std::string regions_table(const Json& regions) {
  Table table({{"region"},
               {"tetrahedra", Align::right},
               {"volume", Align::right},
               {"volume of the CAD", Align::right},
               {"deviation", Align::right, "of the volume of the tetrahedra from that of the CAD"}});
  for (const Json& region : regions) {
    const double volume = number(find(region, "/volume")), cad = number(find(region, "/cad_volume"));
    table.add({name(find(region, "/name")), count(find(region, "/tetrahedra")),
               quantity(find(region, "/volume")), cad > 0 ? quantity(find(region, "/cad_volume")) : "–",
               cad > 0 ? percent(volume / cad - 1) : "–"});
  }
  return part("Regions", table.html());
}

std::string faces_table(const Json& faces) {
  constexpr std::size_t most = 200;  // rows; report.json has all
  if (faces.empty()) return {};
  Table table({{"id", Align::right, "the number of the face in its file, from 0"},
               {"face"},
               {"group"},
               {"patch"},
               {"triangles", Align::right},
               {"area", Align::right},
               {"area of the CAD", Align::right}});
  std::size_t shown = 0;
  for (const Json& face : faces) {
    if (shown++ == most) break;
    const Json &id = find(face, "/id"), &group = find(face, "/group");
    table.add({id.is_null() ? "–" : count(id), name(find(face, "/name")), group.is_null() ? "–" : name(group),
               name(find(face, "/patch")), count(find(face, "/triangles")), quantity(find(face, "/area")),
               quantity(find(face, "/cad_area"))});
  }
  const std::string more =
      faces.size() > most ? paragraph(fmt::format("{} more are in report.json.", faces.size() - most)) : "";
  return part("CAD faces", table.html() + more);
}

std::string changes_table(const Json& changes) {
  Table table({{"what was done"}, {"where"}, {"moved by at most", Align::right}});
  for (const Json& change : changes)
    table.add({long_text(find(change, "/what"), longest_change), place(find(change, "/where")),
               number(find(change, "/how_much")) > 0 ? quantity(find(change, "/how_much")) : "–"});
  return table.html();
}

/// Places of the surface with an angle each: sharp corners, cuts.
std::string corners_table(const std::string& title, const std::string& words, const Json& corners) {
  Table table({{"face"}, {"angle", Align::right}, {"at"}});
  for (const Json& corner : corners)
    table.add(
        {name(find(corner, "/face")), degrees(find(corner, "/degrees")), place(find(corner, "/point"))});
  return table.empty() ? "" : part(title, paragraph(words) + table.html());
}

std::string needles_table(const Json& needles) {
  Table table({{"face"}, {"cause"}, {"triangles", Align::right}, {"smallest angle", Align::right}, {"at"}});
  for (const Json& group : needles) {
    const std::string cause = text(find(group, "/cause"));
    table.add({name(find(group, "/face")),
               cause == "corner"  ? "a sharp corner of the CAD"
               : cause == "strip" ? "curves of the CAD close to each other"
                                  : "the mesh itself",
               count(find(group, "/triangles")), degrees(find(group, "/degrees")),
               place(find(group, "/at"))});
  }
  return part("Surface triangles below 10°", table.html());
}

std::string cusps_table(const Json& cusps) {
  Table table({{"face"}, {"length", Align::right}, {"moved by at most", Align::right}, {"at"}});
  for (const Json& cusp : cusps)
    table.add({name(find(cusp, "/face")), quantity(find(cusp, "/length")), quantity(find(cusp, "/moved")),
               place(find(cusp, "/point"))});
  return part("Cusps of faces that were closed", table.html());
}

std::string retries_table(const Json& report) {
  Table retries({{"zone", Align::right}, {"what was changed"}, {"because"}});
  for (const Json& retry : find(report, "/volume/retries"))
    retries.add({count(find(retry, "/zone")), long_text(find(retry, "/change"), longest_retry),
                 long_text(find(retry, "/reason"), longest_retry)});
  Table places(
      {{"place"}, {"zone that counts", Align::right}, {"faces", Align::right}, {"round", Align::right}});
  for (const Json& item : find(report, "/volume/disagreements"))
    places.add({place(find(item, "/place")), count(find(item, "/zone")), count(find(item, "/faces")),
                count(find(item, "/round"))});
  return part("Zones of the volume that were filled again", retries.html()) +
         part("Places where zones disagreed", places.html());
}

std::string domain_facts(const Json& report) {
  const Json& geometry = find(report, "/geometry");
  if (number(find(geometry, "/faces")) == 0) return {};
  const std::string unit = text(find(geometry, "/unit"));
  std::vector<std::pair<std::string, std::string>> rows = {
      {"unit", unit.empty() ? "not declared" : escaped(unit)},
      {"faces, edges, regions", count(find(geometry, "/faces")) + ", " + count(find(geometry, "/edges")) +
                                    ", " + count(find(geometry, "/regions"))},
      {"from, to", place(find(geometry, "/bounds/0")) + ", " + place(find(geometry, "/bounds/1"))},
      {"reference length", quantity(find(geometry, "/reference_length"))}};
  if (const std::string reason = text(find(geometry, "/domain_reason")); !reason.empty())
    rows.emplace_back("domain", escaped(reason));
  const Json& sizing = find(report, "/sizing");
  if (number(find(sizing, "/maximum")) > 0) {
    rows.emplace_back("sizes",
                      quantity(find(sizing, "/minimum")) + " to " + quantity(find(sizing, "/maximum")));
    rows.emplace_back("at fine features from", quantity(find(sizing, "/feature_minimum")));
    rows.emplace_back("angle per element", degrees(find(sizing, "/curvature_angle")));
    rows.emplace_back("growth", quantity(find(sizing, "/growth")));
    if (const std::string far = text(find(sizing, "/far_field")); !far.empty())
      rows.emplace_back("far field", escaped(far));
  }
  return facts(rows);
}

}  // namespace

std::string places_section(const Json& report) {
  return section("places", "Places to look at",
                 worst_table(find(report, "/quality/places")) + pinned_table(find(report, "/pinned")) +
                     unresolved_table(find(report, "/unresolved_features")));
}

std::string patches_section(const Json& report, const std::vector<Picture>& pictures) {
  const std::map<std::string, std::string> colours = colours_of(pictures);
  Table table({{"patch"},
               {"condition", Align::left, "what goes into solver files"},
               {"triangles", Align::right},
               {"area", Align::right},
               {"area of the CAD", Align::right},
               {"deviation", Align::right, "of the area of the triangles from that of the CAD faces"}});
  for (const Json& patch : find(report, "/patches")) {
    const auto colour = colours.find(text(find(patch, "/name")));
    const Json& cad = find(patch, "/cad_area");
    table.add({(colour == colours.end() ? "" : swatch(colour->second)) + name(find(patch, "/name")),
               escaped(text(find(patch, "/type"))), count(find(patch, "/triangles")),
               quantity(find(patch, "/area")), number(cad) > 0 ? quantity(cad) : "–", deviation(patch)});
  }
  return section(
      "patches", "Patches and regions",
      table.html() + regions_table(find(report, "/regions")) + faces_table(find(report, "/faces")));
}

std::string geometry_section(const Json& report) {
  const std::string changes = changes_table(find(report, "/geometry/changes"));
  std::string body = domain_facts(report);
  if (!body.empty())
    body += part("Changes made to the CAD",
                 changes.empty() ? paragraph("None: it was taken as it is.") : changes);
  body += part("Narrow faces joined with a neighbour", changes_table(find(report, "/sizing/joined_faces")));
  body += cusps_table(find(report, "/surface/closed_tips"));
  body += corners_table("Sharp corners of CAD faces", "One triangle in each is as sharp as the corner.",
                        find(report, "/surface/sharp_corners"));
  body += corners_table("Cuts between pieces below 30°", "Where cuts of divided faces end.",
                        find(report, "/surface/cut_angles/below_30_deg"));
  body += needles_table(find(report, "/surface/needles"));
  return section("geometry", "Geometry, sizes and what was met on the way", body + retries_table(report));
}

}  // namespace aeroloom::report::html
