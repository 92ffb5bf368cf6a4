#include "daemon/export/plot_axes.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "daemon/export/page_text.hpp"
#include "daemon/report/axis_ticks.hpp"

namespace fvd {

namespace {

const cv::Scalar kGrid(228, 228, 228);
constexpr double kLabelSize = 0.45;
constexpr double kTitleSize = 0.5;

}  // namespace

AxisRange padded(AxisRange range, double fraction, double least_span) {
  const double middle = (range.low + range.high) / 2;
  const double half = std::max((range.high - range.low) * (1 + 2 * fraction), least_span) / 2;
  return {middle - half, middle + half};
}

cv::Point2d PlotAxes::at(double x, double y) const {
  return {place_.x + (x - x_.low) / (x_.high - x_.low) * (place_.width - 1),
          place_.y + (y_.high - y) / (y_.high - y_.low) * (place_.height - 1)};
}

void PlotAxes::draw_frame(cv::Mat& page) const {
  cv::rectangle(page, cv::Rect(place_.x - 1, place_.y - 1, place_.width + 2, place_.height + 2), page_colour::kPaleInk);
}

void PlotAxes::draw_x(cv::Mat& page, const std::string& title) const {
  const int bottom = place_.br().y;
  const AxisTicks ticks = axis_ticks(x_.low, x_.high, 9);
  for (const double value : ticks.values) {
    const int x = cvRound(at(value, y_.low).x);
    cv::line(page, {x, place_.y}, {x, bottom - 1}, kGrid);
    cv::line(page, {x, bottom}, {x, bottom + 5}, page_colour::kInk);
    const std::string label = fixed_text(value, ticks.decimals);
    put_text(page, label, {x - text_width(label, kLabelSize) / 2, bottom + 22}, kLabelSize, page_colour::kInk);
  }
  put_text(page, title, {place_.x + (place_.width - text_width(title, kTitleSize)) / 2, bottom + 46}, kTitleSize,
           page_colour::kInk);
}

void PlotAxes::draw_y(cv::Mat& page, const std::string& title) const {
  const AxisTicks ticks = axis_ticks(y_.low, y_.high, 11);
  for (const double value : ticks.values) {
    const int y = cvRound(at(x_.low, value).y);
    cv::line(page, {place_.x, y}, {place_.br().x - 1, y}, kGrid);
    cv::line(page, {place_.x - 6, y}, {place_.x - 1, y}, page_colour::kInk);
    const std::string label = fixed_text(value, ticks.decimals);
    put_text(page, label, {place_.x - 12 - text_width(label, kLabelSize), y + 5}, kLabelSize, page_colour::kInk);
  }
  put_text(page, title, {place_.x, place_.y - 12}, kTitleSize, page_colour::kInk);
}

}  // namespace fvd
