#include "cad/read/length_unit.hpp"

#include "cad/tolerances.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

#include <Interface_Static.hxx>
#include <UnitsMethods.hxx>

namespace aeroloom::cad {
namespace {

constexpr LengthUnit units[] = {
    {"m", 1, "M", 6},           {"mm", 1e-3, "MM", 2},
    {"cm", 1e-2, "CM", 10},     {"km", 1e3, "KM", 7},
    {"um", 1e-6, "UM", 9},      {"in", 0.0254, "INCH", 1},
    {"ft", 0.3048, "FT", 4},    {"mi", 1609.344, "MI", 5},
    {"mil", 2.54e-5, "MIL", 8}, {"uin", 2.54e-8, "UIN", 11},
};

constexpr std::pair<const char*, const char*> synonyms[] = {
    {"metre", "m"},       {"meter", "m"},       {"millimetre", "mm"}, {"millimeter", "mm"},
    {"centimetre", "cm"}, {"centimeter", "cm"}, {"kilometre", "km"},  {"kilometer", "km"},
    {"micrometre", "um"}, {"micrometer", "um"}, {"micron", "um"},     {"inch", "in"},
    {"inches", "in"},     {"foot", "ft"},       {"feet", "ft"},       {"mile", "mi"},
    {"microinch", "uin"},
};

}  // namespace

const LengthUnit& millimetre() {
  return units[1];
}

const LengthUnit* find_length_unit(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const auto& [synonym, usual] : synonyms) {
    if (name == synonym) name = usual;
  }
  for (const LengthUnit& unit : units) {
    if (name == unit.name) return &unit;
  }
  return nullptr;
}

const LengthUnit* find_length_unit(int iges_flag) {
  for (const LengthUnit& unit : units) {
    if (unit.iges_flag == iges_flag) return &unit;
  }
  return nullptr;
}

void set_cad_library_unit(const LengthUnit& unit, double factor) {
  Interface_Static::SetCVal("xstep.cascade.unit", unit.cad_name);
  Interface_Static::SetCVal("write.step.unit", unit.cad_name);
  Interface_Static::SetCVal("write.iges.unit", unit.cad_name);
  UnitsMethods::SetCasCadeLengthUnit(unit.metres * factor, UnitsMethods_LengthUnit_Meter);
}

void set_cad_library_precision(double factor, double stated) {
  constexpr int of_file = 0, given = 1;
  Interface_Static::SetIVal("read.precision.mode", factor == 1 ? of_file : given);
  if (factor == 1) return;
  Interface_Static::SetRVal("read.precision.val",
                            std::clamp(stated, tolerances::library_length, tolerances::most_stated));
}

}  // namespace aeroloom::cad
