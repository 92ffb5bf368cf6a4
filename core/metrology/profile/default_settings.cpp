#include "core/metrology/profile/default_settings.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

namespace fvd::metrology {
namespace {

/// ISO 21920-3:2021, tables of setting classes for Ra.
constexpr std::array<DefaultSettings, 5> kTable{{
    {0.02, 80.0, 400.0},
    {0.1, 250.0, 1250.0},
    {2.0, 800.0, 4000.0},
    {10.0, 2500.0, 12500.0},
    {std::numeric_limits<double>::infinity(), 8000.0, 40000.0},
}};
constexpr int kDefaultSections = 5;

bool equal(double a, double b) { return std::abs(a - b) <= 1e-6 * b; }

}  // namespace

std::span<const DefaultSettings> default_settings_table() noexcept { return kTable; }

const DefaultSettings& default_settings_for(double ra_um) noexcept {
  for (const DefaultSettings& row : kTable) {
    if (ra_um <= row.up_to_ra_um) return row;
  }
  return kTable.back();
}

bool are_default_settings(const DefaultSettings& row, double nesting_um, double evaluation_length_um,
                          int sections) noexcept {
  return sections == kDefaultSections && equal(nesting_um, row.nesting_um) &&
         equal(evaluation_length_um, row.evaluation_length_um);
}

std::string label_with_settings(std::string_view name, bool is_default, double section_length_um, int sections) {
  if (is_default) return std::string(name);
  char text[48];
  std::snprintf(text, sizeof text, " (%.4g mm x %d)", section_length_um * 1e-3, sections);
  return std::string(name) + text;
}

}  // namespace fvd::metrology
