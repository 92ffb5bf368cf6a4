#include "tests/bench/accuracy_scans.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include "drivers/replay/recorded_stack.hpp"

namespace fvd::bench {

ReferenceScan::ReferenceScan(const std::filesystem::path& folder, const Reference& reference,
                             const FocusSettings& settings, WorkerPool& pool)
    : truth_slices_(cv::imread((folder / "truth.tiff").string(), cv::IMREAD_UNCHANGED)) {
  truth_slices_.convertTo(truth_slices_, CV_64F, reference.slices_per_truth, -reference.first_slice);
  for (int i = 0; i < static_cast<int>(truth_slices_.total()); ++i) {
    points_ += std::isnan(truth_slices_.at<double>(i)) ? 0.0 : 1.0;
  }
  const RecordedStack recording(folder);
  stack_ =
      std::make_unique<StreamingFocusStack>(recording.width(), recording.height(), PixelFormat::kMono8, settings, pool);
  for (int k = 0; k < recording.slices(); ++k) {
    const SliceImage slice = recording.read(k);
    Plane<std::uint8_t> narrow(slice.width, slice.height);
    for (std::size_t i = 0; i < narrow.pixels().size(); ++i) {
      narrow.pixels()[i] =
          std::to_integer<std::uint8_t>(slice.pixels[slice.format == PixelFormat::kMono8 ? i : 2 * i + 1]);
    }
    stack_->push(image_view(narrow.view(), PixelFormat::kMono8), k);
  }
}

ErrorSum ReferenceScan::figures_of(const HeightMap& map) const {
  ErrorSum errors;
  for (int y = 0; y < map.mask.height(); ++y) {
    for (int x = 0; x < map.mask.width(); ++x) {
      const double truth = truth_slices_.at<double>(y, x);
      const double measured = static_cast<double>(map.height_m.at(x, y)) * 1e6;
      if (!std::isnan(truth) && !std::isnan(measured)) {
        errors.add(measured - truth, static_cast<double>(map.sigma_m.at(x, y)) * 1e6);
      }
    }
  }
  return errors;
}

std::array<ErrorSum, 4> ReferenceScan::quarters_of(const HeightMap& map) const {
  constexpr int kReach_px = 4;  // about half a window: what lies in it makes the error of a slope
  struct Point {
    double slope;
    double error;
    double sigma;
  };
  std::vector<Point> points;
  for (int y = kReach_px; y < map.mask.height() - kReach_px; ++y) {
    for (int x = kReach_px; x < map.mask.width() - kReach_px; ++x) {
      const double error = static_cast<double>(map.height_m.at(x, y)) * 1e6 - truth(x, y);
      const double slope = std::hypot(truth(x + kReach_px, y) - truth(x - kReach_px, y),
                                      truth(x, y + kReach_px) - truth(x, y - kReach_px));
      if (std::isnan(error) || std::isnan(slope)) continue;
      points.push_back({slope, error, static_cast<double>(map.sigma_m.at(x, y)) * 1e6});
    }
  }
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.slope < b.slope; });
  std::array<ErrorSum, 4> quarters;
  for (std::size_t i = 0; i < points.size(); ++i) quarters[4 * i / points.size()].add(points[i].error, points[i].sigma);
  return quarters;
}

}  // namespace fvd::bench
