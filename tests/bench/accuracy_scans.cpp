#include "tests/bench/accuracy_scans.hpp"

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

}  // namespace fvd::bench
