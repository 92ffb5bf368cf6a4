#pragma once

/// The frame of a plot: grid, ticks, titles, and where a value lies. Only sources of this folder include it: it
/// includes OpenCV.

#include <string>

#include <opencv2/core.hpp>

namespace fvd {

struct AxisRange {
  double low = 0.0;
  double high = 1.0;  ///< > low
};

/// Widened by the fraction at both ends, and to at least least_span.
[[nodiscard]] AxisRange padded(AxisRange range, double fraction, double least_span);

class PlotAxes {
 public:
  /// place: the inside of the frame on the page, in pixels.
  PlotAxes(cv::Rect place, AxisRange x, AxisRange y) : place_(place), x_(x), y_(y) {}

  void draw_frame(cv::Mat& page) const;
  /// Grid lines, tick labels and the title, which names the unit.
  void draw_x(cv::Mat& page, const std::string& title) const;
  void draw_y(cv::Mat& page, const std::string& title) const;

  /// On the page, in pixels; outside the place for a value outside its range.
  [[nodiscard]] cv::Point2d at(double x, double y) const;
  [[nodiscard]] const cv::Rect& place() const { return place_; }
  [[nodiscard]] const AxisRange& x() const { return x_; }
  [[nodiscard]] const AxisRange& y() const { return y_; }

 private:
  cv::Rect place_;
  AxisRange x_;
  AxisRange y_;
};

}  // namespace fvd
