/// The sections of report.html in their order on the page. Each is a function of report.json; a section that
/// has nothing to tell is empty.
#pragma once

#include "pipeline/report/page/html_text.hpp"
#include "pipeline/report/picture.hpp"

#include <string>
#include <vector>

namespace aeroloom::report::html {

using namespace page;  // what pages are made of

/// The case, how its run ended, and the figures that people ask for first.
std::string headline(const Json& report);
/// Of a run that failed: where, why, what to do, how far it came.
std::string failure_section(const Json& report);
/// Limits and what they mean to a solver.
std::string verdict_section(const Json& report);
std::string pictures_section(const std::vector<Picture>& pictures);
std::string histograms_section(const Json& report);
/// The worst elements, and the places of the CAD that force or explain small angles.
std::string places_section(const Json& report);
/// `pictures` tell the colours.
std::string patches_section(const Json& report, const std::vector<Picture>& pictures);
std::string warnings_section(const Json& report);
/// Changes to the CAD, and what the surface mesher met.
std::string geometry_section(const Json& report);
std::string stages_section(const Json& report);
/// Input, versions, configuration.
std::string origin_section(const Json& report);

/// A patch of this colour, "#rrggbb"; nothing for what is no colour.
std::string swatch(const std::string& colour);
/// The name of the run: that of the case, else of the file.
std::string title_of(const Json& report);

}  // namespace aeroloom::report::html
