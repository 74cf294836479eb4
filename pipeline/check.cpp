#include "pipeline/check.hpp"

#include "geometry/place_text.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/log.hpp"
#include "parallel/observation/process_memory.hpp"
#include "pipeline/case/option_keys.hpp"
#include "pipeline/domain/face_patches.hpp"
#include "pipeline/domain/length_ranges.hpp"
#include "pipeline/domain/load_domain.hpp"
#include "pipeline/domain/sandboxed_cad.hpp"
#include "pipeline/domain/size_domain.hpp"
#include "pipeline/forecast.hpp"
#include "pipeline/report/change_json.hpp"
#include "pipeline/report/findings_json.hpp"
#include "pipeline/report/parts_json.hpp"
#include "pipeline/report/task_table.hpp"
#include "pipeline/report/text_file.hpp"
#include "pipeline/shown_changes.hpp"
#include "pipeline/stage_log.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <ios>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace aeroloom::pipeline {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t shown_contacts = 20;  // of faces; `--json` has all
/// For what is advised: enough pieces that ranks can even out what predictions miss, and pieces that are
/// neither all border nor more than a rank should do alone. Chosen, not measured; a run without keys has
/// suitable_piece_tets().
constexpr int pieces_per_rank = 4;
constexpr std::int64_t least_triangles = 1000, most_triangles = 200'000;
constexpr std::int64_t least_tetrahedra = 10'000, most_tetrahedra = 1'000'000;

/// How many ranks a run is worth, by what the clock has of geometry and sizing. Collective.
study::WorthwhileRanks worthwhile_ranks(const parallel::Communicator& communicator,
                                        const parallel::StageClock& clock, const RunForecast& forecast,
                                        const cases::Case& input) {
  const std::string tasks = report::task_table(communicator, clock);
  const Json measured{{"status", "ok"},
                      {"ranks", communicator.size()},
                      {"stages", report::stages_json(clock.summarise(communicator))}};
  if (!communicator.is_root()) return {};
  return predicted_ranks(study::costs_of(measured, tasks), forecast.findings.counts, forecast.layers, input);
}

/// The clock has the stage `geometry`. `scales`: of the family.
RunForecast forecast_run(const cases::TypedPatches& patches, const cases::Case& input,
                         const std::vector<double>& scales, parallel::StageClock& clock,
                         const parallel::Communicator& communicator) {
  RunForecast forecast;
  const double begin = parallel::cpu_seconds();
  clock.begin("sizing");
  const domain::SizedDomain sized =
      domain::size_domain(communicator, patches.model, input.sizing, domain::Simplification::of(input),
                          sizing::FieldFor::forecast);
  parallel::log_verbose(fmt::format("sizing: {:.2f} s of CPU", parallel::cpu_seconds() - begin));
  forecast.sizes = sized.sizes;
  forecast.findings = sized.findings;
  forecast.found = sized.found;
  if (const std::string& text = sized.findings.missed_target; communicator.is_root() && !text.empty())
    parallel::log_warning("sizing: " + text);
  if (sized.level)
    forecast.levels = forecast_levels(*sized.level, sized.findings.counts, input.sizing, communicator.size());
  clock.end();
  sizing::PredictedCounts& counts = forecast.findings.counts;
  parallel::agree(communicator, [&] {
    if (!communicator.is_root()) return;
    forecast.family = forecast_family(scales, sized, patches.types, input, communicator.size());
    if (!input.layers.given) return;
    forecast.layers = forecast_layers(sized.model, patches.types, input, sized.field);
    counts.tetrahedra = forecast.layers->tetrahedra_off_layers(counts.tetrahedra);
    forecast.seconds = forecast.layers->seconds();
    forecast.bytes = forecast.layers->bytes();
  });
  forecast.seconds += predicted_seconds(counts);
  forecast.bytes += predicted_bytes(counts, communicator.size());
  forecast.worthwhile = worthwhile_ranks(communicator, clock, forecast, input);
  const double pieces = pieces_per_rank * communicator.size();
  forecast.piece_triangles =
      std::clamp<std::int64_t>(std::llround(counts.triangles / pieces), least_triangles, most_triangles);
  forecast.piece_tets =
      std::clamp<std::int64_t>(std::llround(counts.tetrahedra / pieces), least_tetrahedra, most_tetrahedra);
  return forecast;
}

std::string describe_reading(const cases::Case& input, const cad::Diagnosis& found) {
  const geometry::Vec3 size = found.bounds.size();
  return fmt::format(
      "read: {}, {}, unit {}\n"
      "      box {} to {}, {:.6g} x {:.6g} x {:.6g}\n"
      "      solids {}, shells {}, faces {}, edges {}\n",
      input.domain.file.empty() ? "the built-in aircraft" : input.domain.file, found.format,
      found.unit_name.empty() ? "not declared" : found.unit_name, geometry::place_text(found.bounds.low),
      geometry::place_text(found.bounds.high), size.x, size.y, size.z, found.counts.solids,
      found.counts.shells, found.counts.faces, found.counts.edges);
}

std::string describe_findings(const CheckRecord& record) {
  const cad::EntityCounts& counts = record.diagnosis.counts;
  std::string text = fmt::format("found: {} open edges, {} short edges, {} sliver faces as read\n",
                                 counts.open_edges, counts.short_edges, counts.sliver_faces);
  for (const cad::Change& finding : record.diagnosis.findings) {
    text += "      " + cad::describe(finding) + "\n";
  }
  if (!record.diagnosis.domain) return text;
  text += fmt::format("      {} pairs of faces intersect or nearly touch\n", record.contact_count);
  const cad::Model& model = record.diagnosis.domain->model;
  for (const FaceContact& contact : record.contacts) {
    text += fmt::format("      faces '{}' and '{}' meet near {}\n", model.face(contact.first).name,
                        model.face(contact.second).name, geometry::place_text(contact.where));
  }
  return text;
}

struct PatchSum {
  int faces = 0;
  double area = 0;
};

std::vector<PatchSum> sum_patches(const cad::Model& model) {
  std::vector<PatchSum> sums(model.patches().size());
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    PatchSum& sum = sums[model.face(f).patch];
    ++sum.faces;
    sum.area += model.face_area(f);
  }
  return sums;
}

std::string describe_domain(const cad::Domain& domain, const std::vector<mesh::PatchType>& types) {
  std::string text;
  for (const cad::Change& change : domain.report.changes) {
    text += "healed: " + cad::describe(change) + "\n";
  }
  text += fmt::format("domain: {}; {} region(s)\n", domain.report.reason, domain.model.region_count());
  std::size_t width = 0;
  for (const std::string& name : domain.model.patches()) width = std::max(width, name.size());
  const std::vector<PatchSum> sums = sum_patches(domain.model);
  for (std::size_t p = 0; p < sums.size(); ++p) {
    text += fmt::format("patch {:<{}}  {:<8}  {:>6} faces, area {:.6g}\n", domain.model.patches()[p], width,
                        mesh::name_of(types.at(p)), sums[p].faces, sums[p].area);
  }
  return text;
}

std::string describe_forecast(const RunForecast& forecast, int ranks) {
  const domain::SizingFindings& findings = forecast.findings;
  std::string text = "far field: " + findings.far_field + "\n";
  for (const domain::JudgedEdge& edge : findings.edges)
    if (edge.fate != domain::EdgeFate::kept) text += "      " + edge.what + "\n";
  for (const std::string& line : shown_changes(findings.joined.changes, "check.json: forecast.joined_faces"))
    text += "a run joins: " + line + "\n";
  const std::string features = findings.features ? describe(*findings.features) : std::string();
  if (!features.empty()) text += "features: " + features + "\n";
  const std::string added = findings.features ? domain::describe_added(*findings.features) : std::string();
  if (!added.empty()) text += "features: " + added + "\n";
  const std::string bounded = describe(findings.bounded, forecast.sizes);
  if (!bounded.empty()) text += "bounds: " + bounded + "\n";
  if (const std::string lost = warning_of(findings.bounded, forecast.sizes); !lost.empty())
    text += "bounds: " + lost + "\n";
  const std::string unseen = describe(findings.walls.unseen);
  if (!unseen.empty()) text += "gaps: " + unseen + "\n";
  const std::string coincident = describe(findings.walls.coincident);
  if (forecast.found) text += describe(*forecast.found);
  return text +
         fmt::format(
             "sizes: {:.4g} to {:.4g}, {:.3g} degrees per element\n"
             "{}"
             "a run: about {:.3g} triangles, {:.3g} tetrahedra, {:.0f} s on one core, {:.1f} GiB\n"
             "       {} rank(s) work with 80 % efficiency ({} where geometry does not count), {:.2g} s, "
             "{:.2g} GiB on the largest\n"
             "       pieces that suit {} rank(s): surface.piece_triangles {}, volume.piece_tets {}\n"
             "{}{}{}\n",
             forecast.sizes.minimum, forecast.sizes.maximum, forecast.sizes.curvature_angle,
             forecast.layers ? describe(*forecast.layers) : "", findings.counts.triangles,
             findings.counts.tetrahedra, forecast.seconds, forecast.bytes / parallel::gibibyte,
             forecast.worthwhile.ranks, forecast.worthwhile.ranks_without_geometry,
             forecast.worthwhile.seconds, forecast.worthwhile.bytes_per_rank / parallel::gibibyte, ranks,
             forecast.piece_triangles, forecast.piece_tets, describe(forecast.levels),
             describe(forecast.family),
             coincident.empty() ? "a volume can be meshed" : "no volume can be meshed: " + coincident);
}

bool is_meshable(const CheckRecord& record) {
  return record.diagnosis.domain.has_value() && record.forecast.findings.walls.coincident.empty();
}

Json read_json(const cases::Case& input, const cad::Diagnosis& found) {
  Json json = {{"file", input.domain.file}, {"format", found.format}, {"unit", found.unit_name}};
  json["bounds"] = {report::to_json(found.bounds.low), report::to_json(found.bounds.high)};
  json["solids"] = found.counts.solids;
  json["shells"] = found.counts.shells;
  json["faces"] = found.counts.faces;
  json["edges"] = found.counts.edges;
  json["open_edges"] = found.counts.open_edges;
  json["short_edges"] = found.counts.short_edges;
  json["sliver_faces"] = found.counts.sliver_faces;
  return json;
}

Json domain_json(const cases::Case& input, const cad::Domain& domain,
                 const std::vector<mesh::PatchType>& types) {
  std::set<std::string> groups;
  for (const cases::GroupRule& rule : input.groups.rules) groups.insert(rule.name);
  Json json = {{"kind", domain.report.kind == cad::DomainKind::fluid ? "fluid" : "body"},
               {"reason", domain.report.reason},
               {"changes", report::to_json(domain.report.changes)}};
  json["regions"] = Json::array();
  for (cad::RegionId r = 0; r < domain.model.region_count(); ++r) {
    json["regions"].push_back(domain.model.region_name(r));
  }
  json["patches"] = Json::array();
  const std::vector<PatchSum> sums = sum_patches(domain.model);
  for (std::size_t p = 0; p < sums.size(); ++p) {
    json["patches"].push_back({{"name", domain.model.patches()[p]},
                               {"type", mesh::name_of(types.at(p))},
                               {"faces", sums[p].faces},
                               {"area", sums[p].area}});
  }
  json["faces"] = Json::array();
  for (cad::FaceId f = 0; f < domain.model.face_count(); ++f) {
    const cad::Face& face = domain.model.face(f);
    Json row = report::face_row(face.name, domain.model.face_place(f));
    const std::string& patch = domain.model.patches()[static_cast<std::size_t>(face.patch)];
    row["id"] = face.number >= 0 ? Json(face.number) : Json();
    row["area"] = domain.model.face_area(f);  // as the condition `area` of a group has it
    row["patch"] = patch;
    row["group"] = groups.count(patch) > 0 ? Json(patch) : Json();
    for (const auto& [key, text] :
         {std::pair("part", &face.part), {"layer", &face.layer}, {"colour", &face.colour}})
      if (!text->empty()) row[key] = *text;
    json["faces"].push_back(std::move(row));
  }
  return json;
}

Json forecast_json(const RunForecast& forecast) {
  const domain::SizingFindings& findings = forecast.findings;
  return {{"minimum", forecast.sizes.minimum},
          {"maximum", forecast.sizes.maximum},
          {"far_field", findings.far_field},
          {"triangles", findings.counts.triangles},
          {"tetrahedra", findings.counts.tetrahedra},
          {"seconds_on_one_core", forecast.seconds},
          {"bytes", forecast.bytes},
          {"layers", forecast.layers ? to_json(*forecast.layers) : Json()},
          {"levels", to_json(forecast.levels)},
          {"family", to_json(forecast.family)},
          {"level", forecast.found ? to_json(*forecast.found) : Json()},
          {"scaling", study::to_json(forecast.worthwhile, {})},
          {"piece_triangles", forecast.piece_triangles},
          {"piece_tets", forecast.piece_tets},
          {"features", findings.features ? report::to_json(*findings.features) : Json()},
          {"bounded_by_minimum", report::to_json(findings.bounded)},
          {"trailing_edges", report::to_json(findings.edges)},
          {"walls", report::to_json(findings.walls)},
          {"joined_faces", report::to_json(findings.joined.changes)}};
}

Json record_json(const cases::Case& input, const CheckRecord& record) {
  Json json = {{"schema_version", 1}, {"meshable", is_meshable(record)}};
  json["read"] = read_json(input, record.diagnosis);
  json["findings"] = report::to_json(record.diagnosis.findings);
  json["contact_count"] = record.contact_count;
  json["contacts"] = Json::array();
  for (const FaceContact& contact : record.contacts) {
    const cad::Model& model = record.diagnosis.domain->model;
    json["contacts"].push_back({{"faces", {model.face(contact.first).name, model.face(contact.second).name}},
                                {"where", report::to_json(contact.where)}});
  }
  if (!record.diagnosis.domain) {
    json["failure"] = record.diagnosis.failure;
    return json;
  }
  json["domain"] = domain_json(input, *record.diagnosis.domain, record.patch_types);
  json["forecast"] = forecast_json(record.forecast);
  return json;
}

void write_record(const cases::Case& input, const CheckRecord& record) {
  report::replace_text(input.output.directory + "/check.json",
                       record_json(input, record).dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

void print_record(const cases::Case& input, const CheckRecord& record, int ranks) {
  const cad::Diagnosis& found = record.diagnosis;
  std::string text = describe_reading(input, found) + describe_findings(record);
  if (found.domain) {
    text += describe_domain(*found.domain, record.patch_types) + describe_forecast(record.forecast, ranks);
  } else {
    text += "no volume can be meshed: " + found.failure + "\n";
  }
  fmt::print("{}", text);
  std::fflush(stdout);
}

}  // namespace

report::ExitCode check_case(const parallel::Communicator& communicator, const cases::Case& input,
                            const FamilyRequest& family) {
  const std::vector<double> scales = scales_of(family, input);
  CheckRecord record;
  parallel::StageClock clock;
  clock.begin("geometry");
  parallel::Bytes bytes;
  parallel::on_root(communicator, [&] {
    record.diagnosis = domain::diagnose_sandboxed(input.domain);
    record.diagnosis.failure = cases::with_keys(std::move(record.diagnosis.failure));
    if (record.diagnosis.domain) bytes = record.diagnosis.domain->model.serialise();
  });
  const bool meshable = communicator.maximum(std::int64_t{record.diagnosis.domain.has_value()}) > 0;
  if (!meshable) clock.end();
  if (meshable) {
    cad::Domain domain{domain::broadcast_model(communicator, std::move(bytes)), {}};
    if (communicator.is_root()) domain.report = record.diagnosis.domain->report;
    domain::require_lengths_of_model(communicator, domain.model, input);
    cases::TypedPatches patches = domain::find_patches(communicator, domain, input);
    clock.end();
    const cad::Model& model = patches.model;
    record.patch_types = patches.types;
    if (communicator.is_root()) warn_of_case(patches, input);
    // One model alone: areas and facets that the forecast needs are not made again.
    if (communicator.is_root()) record.diagnosis.domain->model = model;
    record.forecast = forecast_run(patches, input, scales, clock, communicator);
    parallel::on_root(communicator, [&] {
      record.contacts = find_face_contacts(model, shown_contacts, record.contact_count);
    });
  }
  parallel::on_root(communicator, [&] {
    print_record(input, record, communicator.size());
    // The question whether the case is fit has been answered: a file that cannot be written does not change
    // the answer.
    try {
      write_record(input, record);
    } catch (const std::ios_base::failure& error) {
      parallel::log_warning(fmt::format("check.json is not written: {}", error.what()));
    } catch (const std::filesystem::filesystem_error& error) {
      parallel::log_warning(fmt::format("check.json is not written: {}", error.what()));
    }
  });
  return meshable && record.forecast.findings.walls.coincident.empty() ? report::ExitCode::ok
                                                                       : report::ExitCode::cad;
}

}  // namespace aeroloom::pipeline
