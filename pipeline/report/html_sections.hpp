/// The sections of report.html, in order. Each is a function of report.json; a section without content is
/// empty.
#pragma once

#include "pipeline/report/page/html_text.hpp"
#include "pipeline/report/picture.hpp"

#include <string>
#include <vector>

namespace aeroloom::report::html {

using namespace page;  // elements of pages

/// The case, the outcome of the run, and the main figures.
std::string headline(const Json& report);
/// Of a failed run: stage, reason, remedy, progress.
std::string failure_section(const Json& report);
/// Limits of quality and their meaning for a solver.
std::string verdict_section(const Json& report);
std::string pictures_section(const std::vector<Picture>& pictures);
std::string histograms_section(const Json& report);
/// Faces and cells as cell-centred solvers see them, where they were measured.
std::string solver_section(const Json& report);
/// Boundary layers by patch: what was asked for and made, and what limited them.
std::string layers_section(const Json& report);
/// The worst elements, and places of the CAD that force or explain small angles.
std::string places_section(const Json& report);
/// `pictures` have the colours of the patches.
std::string patches_section(const Json& report, const std::vector<Picture>& pictures);
std::string warnings_section(const Json& report);
/// Changes to the CAD, and difficulties of the surface mesher.
std::string geometry_section(const Json& report);
std::string stages_section(const Json& report);
/// Input, versions, configuration.
std::string origin_section(const Json& report);

/// A small square of the colour "#rrggbb"; empty for other texts.
std::string swatch(const std::string& colour);
/// The name of the run: that of the case file, or else of the geometry.
std::string title_of(const Json& report);

}  // namespace aeroloom::report::html
