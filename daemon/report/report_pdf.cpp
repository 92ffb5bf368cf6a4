#include "daemon/report/report_pdf.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "daemon/report/axis_ticks.hpp"
#include "daemon/report/condition_lines.hpp"
#include "daemon/report/map_plot.hpp"
#include "daemon/report/page_file.hpp"
#include "daemon/report/profile_plot.hpp"
#include "daemon/report/report_head.hpp"
#include "daemon/report/section_title.hpp"
#include "daemon/report/surface_digest.hpp"
#include "daemon/report/value_table.hpp"
#include "daemon/report/view_plot.hpp"
#include "daemon/result/cross_section.hpp"

namespace fvd {

namespace {

constexpr double kMargin = 36.0;
constexpr double kFoot = 14.0;
constexpr double kGap = 8.0;
constexpr int kMostMapPixels = 700;
constexpr std::size_t kMostProfiles = 3;
constexpr double kProfileHeight = 108.0;
constexpr double kMostProfileHeight = 150.0;
constexpr double kLeastPictures = 130.0;
constexpr double kMostPictures = 260.0;
constexpr double kViewHeight = 200.0;
constexpr double kConditionText = 6.5;
constexpr double kSmallConditionText = 5.5;
constexpr double kConditionGap = 1.0;

const PageRect kPage{kMargin, kMargin - 6.0, PdfFile::kWidth - 2.0 * kMargin, PdfFile::kHeight - 2.0 * kMargin + 12.0};

constexpr double kContentBottom = PdfFile::kHeight - kMargin + 6.0 - kFoot;
constexpr double kColourFraction = 0.005;  ///< of the heights, beyond the ends of the colours at either side

struct NamedSection {
  std::string name;
  CrossSection section;
};

std::vector<NamedSection> sections_of(const Result& result) {
  std::vector<NamedSection> sections;
  if (!result.evaluation) return sections;
  for (const std::string& name : result.evaluation->order) {
    const auto found = result.evaluation->measurements.find(name);
    if (found == result.evaluation->measurements.end() || sections.size() == kMostProfiles) continue;
    if (const auto& section = found->second.cross_section) sections.push_back({name, *section});
  }
  return sections;
}

std::string paragraph_of(const ConditionLine& line) { return line.about + ":  " + line.text; }

/// The pages of one report, drawn from top to bottom.
class Report {
 public:
  Report(const Result& result, const PictureSurface& surface)
      : result_(result),
        surface_(surface),
        sha256_(surface_sha256(surface.height_m)),
        sections_(sections_of(result)),
        rows_(value_rows(result)),
        lines_(condition_lines(result)),
        file_({report_title(result), "fvd " + result.provenance.software_version, result.provenance.created}),
        canvas_(file_.canvas()) {}

  std::string bytes() {
    draw_first_page();
    while (goes_on()) draw_further_page();
    return file_.bytes();
  }

 private:
  [[nodiscard]] bool goes_on() const { return next_row_ < rows_.size() || next_line_ < lines_.size(); }
  [[nodiscard]] double profiles_height() const { return sections_.empty() ? 0.0 : profile_height_ + kGap; }
  [[nodiscard]] double conditions_height();
  /// Of the room between head, table and conditions: the conditions' text becomes smaller where it is too little, the
  /// profiles higher where it is more than the pictures need.
  [[nodiscard]] double pictures_height(double left);
  void draw_first_page();
  void draw_further_page();
  void draw_pictures(double top, double height);
  void draw_profiles(double top);
  double draw_rows(double top, std::size_t most);
  /// As many as fit.
  void draw_conditions(double top);

  const Result& result_;
  const PictureSurface& surface_;
  std::string sha256_;
  std::vector<NamedSection> sections_;
  std::vector<ValueRow> rows_;
  std::vector<ConditionLine> lines_;
  PdfFile file_;
  Canvas& canvas_;
  double profile_height_ = kProfileHeight;
  double text_size_ = kConditionText;
  std::size_t next_row_ = 0;
  std::size_t next_line_ = 0;
  int page_ = 1;
};

double Report::conditions_height() {
  double height = 0.0;
  for (const ConditionLine& line : lines_) {
    height += kConditionGap +
              canvas_.paragraph_height(kPage.width, paragraph_of(line), {.size = text_size_}, line.about.size() + 1);
  }
  return height;
}

double Report::pictures_height(double left) {
  const double height = left - conditions_height();
  // No higher than the map needs in its half of the page.
  const PageRect field = field_place(surface_, {0.0, 0.0, (kPage.width - kGap) / 2.0, kMostPictures});
  const double most = std::clamp(field.height + kMapBottom + 4.0, kViewHeight, kMostPictures);
  if (height >= kLeastPictures) {
    profile_height_ = std::clamp(kProfileHeight + height - most, kProfileHeight, kMostProfileHeight);
    return std::min(height, most);
  }
  text_size_ = kSmallConditionText;
  return std::clamp(left - conditions_height(), kLeastPictures, most);
}

void Report::draw_first_page() {
  double y = draw_head(canvas_, kPage, result_);
  const std::size_t rows = std::min(rows_.size(), std::size_t{kValuesOnFirstPage});
  const double table = table_height(rows) + kGap;
  const double pictures = pictures_height(kContentBottom - y - kGap - profiles_height() - table);
  draw_pictures(y, pictures);
  y += pictures + kGap;
  draw_profiles(y);
  y += profiles_height();
  y = draw_rows(y, rows);
  // Conditions come behind the last value.
  if (next_row_ == rows_.size()) draw_conditions(y);
  draw_foot(canvas_, kPage, result_, sha256_, page_, goes_on());
}

void Report::draw_further_page() {
  file_.next_page();
  ++page_;
  double y = draw_short_head(canvas_, kPage, result_);
  const auto fitting = static_cast<std::size_t>((kContentBottom - y) / (table_height(2) - table_height(1))) - 2;
  if (next_row_ < rows_.size()) y = draw_rows(y, std::min(fitting, rows_.size() - next_row_));
  if (next_row_ == rows_.size()) draw_conditions(y);
  draw_foot(canvas_, kPage, result_, sha256_, page_, goes_on());
}

void Report::draw_pictures(double top, double height) {
  const double half = (kPage.width - kGap) / 2.0;
  const PageRect field = field_place(surface_, {kPage.x, top + 4.0, half, height - 4.0});
  const ScalarImage image = shrunk_um(surface_.height_m, kMostMapPixels);
  const ValueRange range = robust_range(image, kColourFraction);
  draw_map(canvas_, field, surface_, coloured(image, range, ColourScale::kViridis));
  draw_colour_bar(canvas_, field, range, ColourScale::kViridis, "height / µm");
  draw_view(canvas_, {kPage.x + half + kGap, top, half, height}, surface_);
}

void Report::draw_profiles(double top) {
  const auto count = static_cast<double>(sections_.size());
  const double width = (kPage.width - kGap * (count - 1.0)) / count;
  double x = kPage.x;
  for (const auto& [name, section] : sections_) {
    draw_profile(canvas_, {x, top, width, profile_height_}, surface_, section, section_title(name, section));
    x += width + kGap;
  }
}

double Report::draw_rows(double top, std::size_t most) {
  std::vector<ValueRow> rows(rows_.begin() + static_cast<std::ptrdiff_t>(next_row_),
                             rows_.begin() + static_cast<std::ptrdiff_t>(next_row_ + most));
  // The measurement that goes on from another page is named again.
  for (std::size_t i = next_row_; !rows.empty() && rows.front().measurement.empty() && i-- > 0;) {
    rows.front().measurement = rows_[i].measurement;
  }
  draw_table(canvas_, {kPage.x, top}, kPage.width, rows);
  next_row_ += most;
  return top + table_height(most) + kGap;
}

void Report::draw_conditions(double top) {
  double y = top;
  for (; next_line_ < lines_.size(); ++next_line_) {
    const ConditionLine& line = lines_[next_line_];
    const TextStyle style{.size = text_size_};
    const double height = canvas_.paragraph_height(kPage.width, paragraph_of(line), style, line.about.size() + 1);
    // One that is longer than a page is cut by its end: a page without any would be followed by another without end.
    if (y + height > kContentBottom && y > top) return;
    canvas_.paragraph({kPage.x, y}, kPage.width, paragraph_of(line), style, line.about.size() + 1);
    y += height + kConditionGap;
  }
}

}  // namespace

std::string report_pdf(const Result& result, const PictureSurface& surface) { return Report(result, surface).bytes(); }

}  // namespace fvd
