#include "core/scan/autofocus.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "core/base/error.hpp"
#include "core/scan/slice_capture.hpp"

namespace fvd {

namespace {

constexpr double kFineStepShare = 0.25;
constexpr int kMinSteps = 3;
constexpr int kMaxSteps = 1000;
/// A maximum that stands out less over the lowest value is noise.
constexpr double kMinPeakOverLowest = 1.05;

template <typename Pixel>
double mean_laplacian(PlaneView<const Pixel> image, const Region& region) {
  double sum = 0.0;
  for (int y = region.y; y < region.y + region.height; ++y) {
    const Pixel* row = image.row(y);
    const Pixel* up = image.row(y - 1);
    const Pixel* down = image.row(y + 1);
    long row_sum = 0;
    for (int x = region.x; x < region.x + region.width; ++x) {
      const int twice = 2 * row[x];
      row_sum += std::abs(twice - row[x - 1] - row[x + 1]) + std::abs(twice - up[x] - down[x]);
    }
    sum += static_cast<double>(row_sum);
  }
  return sum / (static_cast<double>(region.width) * region.height);
}

class Searcher {
 public:
  Searcher(Camera& camera, Axis& stage, Clock& clock, const AutofocusPlan& plan, std::stop_token stop)
      : stage_(stage), plan_(plan), stop_(std::move(stop)), capture_(camera, clock, ledger_) {}

  /// Arrives from below, and says how sharp it is there.
  FocusSample look(Micrometers target) {
    const MoveRecord move = arrive(target);
    const auto captured = capture_.capture(move.settled, plan_.frame_retries, stop_);
    if (!captured) {
      throw capture_.failure("no good frame at " + std::to_string(target.value) + " um");
    }
    const ImageView& image = captured->frame.image;
    const double z_um = stage_.mean_position(captured->frame.exposure_start, captured->frame.exposure_end).mean.value;
    return {z_um, mean_focus(image, central_region(image.width, image.height))};
  }

  MoveRecord arrive(Micrometers target) {
    if (!last_ || target < *last_) {
      SettleCriterion wide = plan_.settle;
      const Micrometers take_up = stage_.info().take_up;
      wide.window = std::max(plan_.settle.window, take_up * 0.5);
      if (take_up.value > 0) stage_.move_to(target - take_up, wide, stop_);
    }
    last_ = target;
    return stage_.move_to(target, plan_.settle, stop_);
  }

  /// From `from` to `to`, both included.
  void scan(Micrometers from, Micrometers to, Micrometers step, std::vector<FocusSample>& curve) {
    const int count = static_cast<int>(std::floor((to - from).value / step.value + 1e-6));
    for (int i = 0; i <= count; ++i) curve.push_back(look(from + static_cast<double>(i) * step));
  }

 private:
  Axis& stage_;
  const AutofocusPlan& plan_;
  std::stop_token stop_;
  FrameLedger ledger_;
  SliceCapture capture_;
  std::optional<Micrometers> last_;
};

std::size_t sharpest(const std::vector<FocusSample>& curve) {
  return static_cast<std::size_t>(
      std::max_element(curve.begin(), curve.end(), [](auto& a, auto& b) { return a.focus < b.focus; }) - curve.begin());
}

/// Vertex of the parabola through the logarithms of three samples.
double vertex_um(const FocusSample& a, const FocusSample& b, const FocusSample& c) {
  if (!(a.z_um < b.z_um && b.z_um < c.z_um)) return b.z_um;  // steps below the resolution of the encoder
  const double la = std::log(std::max(a.focus, 1e-9));
  const double lb = std::log(std::max(b.focus, 1e-9));
  const double lc = std::log(std::max(c.focus, 1e-9));
  const double left = (lb - la) / (b.z_um - a.z_um);
  const double right = (lc - lb) / (c.z_um - b.z_um);
  if (left <= right) return b.z_um;
  const double ab = (a.z_um + b.z_um) / 2;
  const double bc = (b.z_um + c.z_um) / 2;
  return std::clamp(ab + left / (left - right) * (bc - ab), a.z_um, c.z_um);
}

}  // namespace

Region central_region(int width, int height) { return {width / 4, height / 4, width / 2, height / 2}; }

double mean_focus(const ImageView& image, const Region& region) {
  Region inner;
  inner.x = std::max(region.x, 1);
  inner.y = std::max(region.y, 1);
  inner.width = std::min(region.x + region.width, image.width - 1) - inner.x;
  inner.height = std::min(region.y + region.height, image.height - 1) - inner.y;
  if (inner.width <= 0 || inner.height <= 0) return 0.0;
  return bytes_per_pixel(image.format) == 1 ? mean_laplacian(image.as<std::uint8_t>(), inner)
                                            : mean_laplacian(image.as<std::uint16_t>(), inner);
}

void check_plan(const AutofocusPlan& plan, const StageInfo& stage) {
  std::ostringstream why;
  ErrorCode code = ErrorCode::kBadInput;
  const double range_um = (plan.to - plan.from).value;
  if (range_um <= 0.0) {
    why << "from " << plan.from.value << " to " << plan.to.value << " um is no range: from_um must be below to_um";
  } else if (!(plan.step.value > 0.0) || range_um < kMinSteps * plan.step.value) {
    why << "the range of an autofocus must hold " << kMinSteps << " of its steps at least";
  } else if (range_um > kMaxSteps * plan.step.value) {
    why << "a range of " << range_um << " um holds more than " << kMaxSteps << " steps of " << plan.step.value
        << " um: a larger step_um or a smaller range";
  } else if (plan.from - stage.take_up < stage.min || plan.to > stage.max) {
    code = ErrorCode::kStageLimit;
    why << "from " << plan.from.value << " to " << plan.to.value << " um, with " << stage.take_up.value
        << " um of take-up below, is outside the stage's limits of " << stage.min.value << ".." << stage.max.value
        << " um; nothing was moved";
  } else {
    return;
  }
  throw Error(code, why.str());
}

AutofocusResult autofocus(Camera& camera, Axis& stage, Clock& clock, const AutofocusPlan& plan, std::stop_token stop) {
  check_plan(plan, stage.info());
  if (!stage.status().homed) {
    throw Error(ErrorCode::kStageNotHomed, "the stage has no reference: a job homes it, or stage.home");
  }
  Searcher searcher(camera, stage, clock, plan, stop);
  AutofocusResult result;
  searcher.scan(plan.from, plan.to, plan.step, result.curve);
  const std::size_t best = sharpest(result.curve);
  const auto lowest =
      std::min_element(result.curve.begin(), result.curve.end(), [](auto& a, auto& b) { return a.focus < b.focus; });
  if (best == 0 || best + 1 == result.curve.size() || result.curve[best].focus < kMinPeakOverLowest * lowest->focus) {
    std::ostringstream message;
    message << "the region is nowhere sharpest between " << plan.from.value << " and " << plan.to.value
            << " um: move or widen the range, and check light and texture";
    throw Error(ErrorCode::kFocusRange, message.str());
  }
  std::vector<FocusSample> fine;
  const Micrometers middle{result.curve[best].z_um};
  // Where the stage stood is not quite where it was sent, and the range is where it may go.
  searcher.scan(std::max(middle - plan.step, plan.from), std::min(middle + plan.step, plan.to),
                plan.step * kFineStepShare, fine);
  const std::size_t top = std::clamp<std::size_t>(sharpest(fine), 1, fine.size() - 2);
  result.focus = fine[top].focus;
  result.z_um = std::clamp(vertex_um(fine[top - 1], fine[top], fine[top + 1]), plan.from.value, plan.to.value);
  result.curve.insert(result.curve.end(), fine.begin(), fine.end());
  std::sort(result.curve.begin(), result.curve.end(), [](auto& a, auto& b) { return a.z_um < b.z_um; });
  searcher.arrive(Micrometers{result.z_um});
  return result;
}

}  // namespace fvd
