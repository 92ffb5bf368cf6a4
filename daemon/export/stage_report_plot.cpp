#include <algorithm>
#include <cmath>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "core/base/error.hpp"
#include "daemon/export/json_values.hpp"
#include "daemon/export/page_text.hpp"
#include "daemon/export/plot_axes.hpp"
#include "daemon/export/png_bytes.hpp"
#include "daemon/export/stage_report_figures.hpp"
#include "daemon/export/stage_report_files.hpp"

namespace fvd {

namespace {

constexpr int kWidth = 1200;
constexpr int kHeight = 800;
constexpr int kMargin = 24;
const cv::Rect kPlot(84, 112, 776, 530);
constexpr int kColumn = 892;  // left end of legend and figures
constexpr int kFirstCaveat = 716;
constexpr std::size_t kCaveatLines = 5;

// Blue and vermillion of Okabe and Ito: told apart by every eye. Points pale, curves full.
struct SideColours {
  cv::Scalar point;
  cv::Scalar curve;
};
const SideColours kBelow{{224, 176, 96}, {150, 84, 0}};
const SideColours kAbove{{110, 160, 240}, {0, 70, 190}};
const cv::Scalar kZero(120, 120, 120);

constexpr int kShift = 4;  // fixed-point bits, so that circles and curves do not jump from pixel to pixel
cv::Point fixed_point(const cv::Point2d& p) { return {cvRound(p.x * (1 << kShift)), cvRound(p.y * (1 << kShift))}; }

void draw_point(cv::Mat& page, const cv::Point2d& at, double radius, const cv::Scalar& colour) {
  cv::circle(page, fixed_point(at), cvRound(radius * (1 << kShift)), colour, cv::FILLED, cv::LINE_AA, kShift);
}

std::vector<int> curve_sides(const StageFit& fit) {
  return fit.reversal_um ? std::vector<int>{1, -1} : std::vector<int>{0};
}

cv::Scalar curve_colour(int side) { return side == 0 ? page_colour::kInk : side > 0 ? kBelow.curve : kAbove.curve; }

/// Of the errors, with zero in it unless that would press the errors together.
AxisRange error_range(const std::vector<StagePoint>& points) {
  AxisRange range{1e300, -1e300};
  for (const auto& p : points) {
    range.low = std::min(range.low, p.measured_um - p.quantised_um);
    range.high = std::max(range.high, p.measured_um - p.quantised_um);
  }
  const AxisRange with_zero{std::min(0.0, range.low), std::max(0.0, range.high)};
  constexpr double kPressed = 3.0;
  const bool near = with_zero.high - with_zero.low <= kPressed * (range.high - range.low);
  return padded(near || range.high <= range.low ? with_zero : range, 0.05, 0.01);
}

AxisRange position_range(const StageReport& report) {
  if (!report.range_um) return {};
  return padded({report.range_um->low, report.range_um->high}, 0.02, 1.0);
}

void draw_curve(cv::Mat& page, const PlotAxes& axes, const StageFit& fit, const Span& range_um, int side) {
  std::vector<cv::Point> line;
  constexpr int kSamplesPerPixel = 4;  // a short lead has many turns in a pixel's neighbourhood
  const int samples = kPlot.width * kSamplesPerPixel;
  for (int i = 0; i <= samples; ++i) {
    const double z = range_um.low + (range_um.high - range_um.low) * i / samples;
    line.push_back(fixed_point(axes.at(z, fitted_error_um(fit, z, side))));
  }
  cv::polylines(page, line, false, curve_colour(side), 2, cv::LINE_AA, kShift);
}

void draw_data(cv::Mat& page, const PlotAxes& axes, const std::vector<StagePoint>& points, const StageReport& report) {
  cv::Mat inside = page(kPlot);  // what lies outside of the frame is cut off
  const PlotAxes local(cv::Rect(0, 0, kPlot.width, kPlot.height), axes.x(), axes.y());
  if (axes.y().low < 0.0 && axes.y().high > 0.0) {
    const int y = cvRound(local.at(0.0, 0.0).y);
    cv::line(inside, {0, y}, {kPlot.width, y}, kZero, 1);
  }
  const double radius = points.size() > 2000 ? 1.5 : points.size() > 400 ? 2.5 : 3.2;
  for (const auto& p : points) {
    draw_point(inside, local.at(p.quantised_um, p.measured_um - p.quantised_um), radius,
               p.direction > 0 ? kBelow.point : kAbove.point);
  }
  if (!report.fit || !report.fit->alpha_z) return;
  for (const int side : curve_sides(*report.fit)) draw_curve(inside, local, *report.fit, *report.range_um, side);
}

void draw_not_observable(cv::Mat& page) {
  const std::string words = "not observable";
  const std::string why = "step counting without feedback: there is no measured position";
  const int middle = kPlot.x + kPlot.width / 2;
  const int y = kPlot.y + kPlot.height / 2;
  put_text(page, words, {middle - text_width(words, 1.2, 2) / 2, y}, 1.2, page_colour::kPaleInk, 2);
  put_text(page, why, {middle - text_width(why, 0.5) / 2, y + 34}, 0.5, page_colour::kPaleInk);
}

/// Returns the height used.
int draw_legend(cv::Mat& page, const std::vector<StagePoint>& points, const StageReport& report) {
  int y = kPlot.y + 4;
  const auto entry = [&](const std::string& text, auto mark) {
    mark(y - 5);
    put_text(page, text, {kColumn + 36, y}, 0.45, page_colour::kInk);
    y += 21;
  };
  const auto has = [&points](int side) {
    return std::any_of(points.begin(), points.end(), [side](const StagePoint& p) { return p.direction == side; });
  };
  const auto dot = [&page](const cv::Scalar& colour) {
    return [&page, colour](int at) { draw_point(page, {kColumn + 12.0, static_cast<double>(at)}, 4.0, colour); };
  };
  const auto stroke = [&page](const cv::Scalar& colour) {
    return [&page, colour](int at) { cv::line(page, {kColumn, at}, {kColumn + 24, at}, colour, 2, cv::LINE_AA); };
  };
  if (has(1)) entry("approached from below", dot(kBelow.point));
  if (has(-1)) entry("approached from above", dot(kAbove.point));
  if (report.fit && report.fit->alpha_z) {
    const std::string what = report.fit->lead ? "fit with lead error" : "fit";
    if (report.fit->reversal_um) {
      entry(what + ", from below", stroke(kBelow.curve));
      entry(what + ", from above", stroke(kAbove.curve));
    } else {
      entry(what, stroke(page_colour::kInk));
    }
    if (report.fit->drift_um_per_min) {
      put_text(page, "drift taken at the middle of the run", {kColumn + 36, y}, 0.42, page_colour::kPaleInk);
      y += 18;
    }
  }
  return y;
}

void draw_figures(cv::Mat& page, const StageReport& report, int y) {
  const auto lines = figure_lines(report);
  const auto headings =
      std::count_if(lines.begin(), lines.end(), [](const FigureLine& line) { return line.value.empty(); });
  constexpr int kHeadingExtra = 10;
  const int room = kHeight - kMargin / 2 - y - kHeadingExtra * static_cast<int>(headings);
  const int pitch = std::min(18, room / std::max(1, static_cast<int>(lines.size())));
  const int right = kWidth - kMargin;
  for (const FigureLine& line : lines) {
    if (line.value.empty()) {
      y += kHeadingExtra - 4;
      put_text(page, line.name, {kColumn, y}, 0.45, page_colour::kInk);
      cv::line(page, {kColumn, y + 5}, {right, y + 5}, kZero);
      y += pitch + 4;
      continue;
    }
    put_text(page, line.name, {kColumn, y}, 0.42, page_colour::kPaleInk);
    put_text(page, line.value, {right - text_width(line.value, 0.42), y}, 0.42, page_colour::kInk);
    y += pitch;
  }
}

void draw_caveats(cv::Mat& page, const StageReport& report) {
  constexpr double kSize = 0.4;
  constexpr int kIndent = 12;
  std::vector<std::pair<int, std::string>> lines;  // indent, text
  for (const std::string& caveat : report.caveats) {
    const char* mark = "- ";
    for (const auto& part : wrapped_text(caveat, kSize, kColumn - 2 * kMargin - kIndent)) {
      lines.emplace_back(*mark == '-' ? 0 : kIndent, mark + part);
      mark = "";
    }
  }
  if (lines.size() > kCaveatLines) {
    lines.resize(kCaveatLines - 1);
    lines.emplace_back(0, "- and more: all of them are in stage_accuracy.json");
  }
  int y = kFirstCaveat;
  for (const auto& [indent, text] : lines) {
    put_text(page, text, {kMargin + indent, y}, kSize, page_colour::kPaleInk);
    y += 17;
  }
}

std::string subtitle(const StageReport& report, const StageReportHeader& header) {
  std::string feedback = feedback_name(report.feedback);
  std::replace(feedback.begin(), feedback.end(), '_', ' ');
  const std::string date = iso8601_utc(header.date);
  std::string text = date.substr(0, 10) + " " + date.substr(11, 5) + " UTC";
  if (!header.address.empty()) text += ", " + header.address;
  text += ", feedback: " + feedback + ", " + std::to_string(report.n) + " points";
  if (!header.software_version.empty()) text += ", fvd " + header.software_version;
  return text;
}

}  // namespace

std::string stage_report_png(const std::vector<StagePoint>& points, const StageReport& report,
                             const StageReportHeader& header) {
  try {
    cv::Mat page(kHeight, kWidth, CV_8UC3, page_colour::kBackground);
    draw_page_header(page, "Stage accuracy: " + (header.profile.empty() ? "unknown profile" : header.profile),
                     subtitle(report, header), header.simulated.value_or(false), kMargin);
    const bool data = report.observable && !points.empty();
    const PlotAxes axes(kPlot, position_range(report), data ? error_range(points) : AxisRange{-1.0, 1.0});
    if (!points.empty()) axes.draw_x(page, "quantised position z, um");
    if (data) axes.draw_y(page, "measured - quantised, um");  // no scale for what is not there
    axes.draw_frame(page);
    if (data) {
      draw_data(page, axes, points, report);
    } else if (!report.observable) {
      draw_not_observable(page);
    }
    const int y = draw_legend(page, data ? points : std::vector<StagePoint>{}, report);
    draw_figures(page, report, y + 6);
    draw_caveats(page, report);
    return png_bytes(page);
  } catch (const cv::Exception& failure) {
    throw Error(ErrorCode::kInternal, std::string("the stage report could not be drawn: ") + failure.what());
  }
}

}  // namespace fvd
