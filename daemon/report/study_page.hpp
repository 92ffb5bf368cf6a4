#pragma once

/// The report of a study for people: one page of A4, as a PDF file.

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/image/image.hpp"

namespace fvd {

/// From the centre of the first pixel; right and down.
struct StudyArrow {
  double column = 0.0;
  double row = 0.0;
  double x_um = 0.0;
  double y_um = 0.0;
};

/// A map of the field.
struct StudyMap {
  Plane<float> height_m;  ///< metres, NaN = hole
  double pitch_x_um = 1.0;
  double pitch_y_um = 1.0;
  std::string title;                    ///< what the colours are, with its unit: "noise / µm"
  bool errors = false;                  ///< colours of standard errors in place of those of heights
  std::vector<StudyArrow> arrows = {};  ///< of one scale, so that the longest is well seen
  std::string arrows_title = {};        ///< what they are, with the length of the longest
};

struct StudyPlotPoint {
  double x = 0.0;
  double y = 0.0;
  std::optional<double> u;  ///< bars of +- 2 u
};

/// Points over an axis, with a line at 0.
struct StudyPlot {
  std::string title;
  std::string x_title;  ///< with its unit
  std::string y_title;
  std::vector<StudyPlotPoint> points;  ///< finite
};

struct StudyRow {
  std::string name;
  std::string value;        ///< "-" where there is none
  std::string uncertainty;  ///< U and k
  std::string unit;
  std::string reason;  ///< why there is no value
};

/// Cells and lines as text, in UTF-8.
struct StudyPage {
  std::string title;
  std::string subtitle;
  std::vector<std::pair<std::string, std::string>> facts;  ///< name and value, in two columns
  bool simulated = false;
  std::optional<StudyMap> map;
  std::optional<StudyPlot> plot;
  std::vector<StudyRow> rows;
  std::vector<std::pair<std::string, std::string>> notes;  ///< about what, and the text
  std::string software_version;
  std::string foot;
  std::chrono::system_clock::time_point created;
};

/// What does not fit on the page is left out from its end, and the page says how much. The same study gives the same
/// bytes. Throws Error kInternal. context: thread-safe. About 0.1 s.
[[nodiscard]] std::string study_pdf(const StudyPage& page);

}  // namespace fvd
