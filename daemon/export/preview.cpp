#include "daemon/export/preview.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "core/base/error.hpp"
#include "core/base/units.hpp"
#include "daemon/export/export_input.hpp"
#include "daemon/export/page_text.hpp"
#include "daemon/export/png_bytes.hpp"
#include "daemon/report/axis_ticks.hpp"

namespace fvd {

namespace {

constexpr int kMaxMapWidth = 1400;
constexpr int kMaxMapHeight = 1000;
constexpr int kMinMapSide = 400;  // smaller maps are enlarged up to about this
constexpr int kMargin = 24;
constexpr int kHeaderHeight = 84;
constexpr int kFooterHeight = 52;
constexpr int kMinBarHeight = 120;
constexpr int kBarWidth = 26;
constexpr int kBarSpace = 190;  // gap, bar, tick marks and labels

using page_colour::kBackground;
using page_colour::kInk;
using page_colour::kPaleInk;
const cv::Scalar kHole(170, 170, 170);

/// Robust limits, widened where the map is flat or empty so that they always differ.
struct ColourRange {
  double low_um = 0.0;
  double high_um = 1.0;
};

ColourRange colour_limits(const HeightSummary& summary) {
  if (!summary.height) return {};
  const double low = summary.height->low_um;
  const double high = summary.height->high_um;
  const double least = std::max(1e-3, 1e-6 * std::abs(high));  // 1 nm, or what float32 can tell apart
  if (high - low >= least) return {low, high};
  const double middle = (low + high) / 2;
  return {middle - 5 * least, middle + 5 * least};
}

/// Heights in um at the size they are drawn at; valid is the fraction of valid points under each pixel, 0..1.
struct DrawnMap {
  cv::Mat height_um;  // CV_32F
  cv::Mat valid;      // CV_32F
};

cv::Size drawn_size(int width, int height) {
  const double shrink = std::max({1.0, width / double{kMaxMapWidth}, height / double{kMaxMapHeight}});
  if (shrink > 1.0) {
    return {std::max(1, static_cast<int>(std::lround(width / shrink))),
            std::max(1, static_cast<int>(std::lround(height / shrink)))};
  }
  const int enlarge = std::clamp(
      std::min({kMinMapSide / std::max(width, height), kMaxMapWidth / width, kMaxMapHeight / height}), 1, 64);
  return {width * enlarge, height * enlarge};
}

DrawnMap resample(const HeightMap& map) {
  const int width = map.height_m.width();
  const int height = map.height_m.height();
  cv::Mat weighted(height, width, CV_32F);
  cv::Mat valid(height, width, CV_32F);
  constexpr auto kMicrometresPerMetre = static_cast<float>(1.0 / kMetresPerMicrometer);
  for (int y = 0; y < height; ++y) {
    const float* heights = map.height_m.row(y);
    auto* weighted_row = weighted.ptr<float>(y);
    auto* valid_row = valid.ptr<float>(y);
    for (int x = 0; x < width; ++x) {
      const bool good = std::isfinite(heights[x]);
      valid_row[x] = good ? 1.0F : 0.0F;
      weighted_row[x] = good ? heights[x] * kMicrometresPerMetre : 0.0F;
    }
  }
  const cv::Size size = drawn_size(width, height);
  const int method = size.width < width || size.height < height ? cv::INTER_AREA : cv::INTER_NEAREST;
  DrawnMap drawn;
  cv::resize(weighted, weighted, size, 0, 0, method);
  cv::resize(valid, drawn.valid, size, 0, 0, method);
  cv::divide(weighted, cv::max(drawn.valid, 1e-6), drawn.height_um);  // mean of the valid points
  return drawn;
}

// Not cividis: its middle is as grey as the holes.
cv::Mat viridis(const cv::Mat& levels) {
  cv::Mat colours;
  cv::applyColorMap(levels, colours, cv::COLORMAP_VIRIDIS);
  return colours;
}

cv::Mat coloured(const DrawnMap& drawn, const ColourRange& limits) {
  const double scale = 255.0 / (limits.high_um - limits.low_um);
  cv::Mat levels;
  drawn.height_um.convertTo(levels, CV_8U, scale, -limits.low_um * scale);
  cv::Mat colours = viridis(levels);
  colours.setTo(kHole, drawn.valid < 0.5);
  return colours;
}

void draw_colour_bar(cv::Mat& page, const cv::Rect& map, const ColourRange& limits, bool empty) {
  const cv::Rect bar(map.br().x + kMargin, map.y, kBarWidth, map.height);
  cv::Mat ramp(bar.height, 1, CV_8U);
  for (int y = 0; y < bar.height; ++y) {
    ramp.at<std::uint8_t>(y, 0) = static_cast<std::uint8_t>(255 - 255 * y / std::max(1, bar.height - 1));
  }
  cv::Mat colours;
  cv::resize(empty ? cv::Mat(bar.height, 1, CV_8UC3, kHole) : viridis(ramp), colours, bar.size(), 0, 0,
             cv::INTER_NEAREST);
  colours.copyTo(page(bar));
  cv::rectangle(page, bar, kInk);
  put_text(page, "um", {bar.x, bar.br().y + 16}, 0.5, kInk);  // above the bar the header's text may reach
  if (empty) {
    put_text(page, "no valid points", {bar.br().x + 8, bar.y + 16}, 0.45, kPaleInk);
    return;
  }
  const AxisTicks ticks = axis_ticks(limits.low_um, limits.high_um, std::clamp(bar.height / 50, 3, 11));
  for (const double value : ticks.values) {
    const double fraction = (value - limits.low_um) / (limits.high_um - limits.low_um);
    const int y = bar.y + static_cast<int>(std::lround((1.0 - fraction) * (bar.height - 1)));
    cv::line(page, {bar.br().x, y}, {bar.br().x + 5, y}, kInk);
    put_text(page, fixed_text(value, ticks.decimals), {bar.br().x + 10, y + 5}, 0.45, kInk);
  }
}

/// Left: what grey means. Right: a scale bar where the pixel pitch is known.
void draw_footer(cv::Mat& page, const cv::Rect& map, const PreviewText& text, double um_per_drawn_px) {
  const int y = map.br().y + 30;
  const cv::Rect sample(map.x, y - 12, 14, 14);
  cv::rectangle(page, sample, kHole, cv::FILLED);
  cv::rectangle(page, sample, kInk);
  put_text(page, "no valid height", {map.x + 22, y}, 0.45, kInk);
  if (text.pitch_x_um <= 0) return;
  const double length_um = round_step(map.width * um_per_drawn_px / 4);
  const int length_px = std::max(1, static_cast<int>(std::lround(length_um / um_per_drawn_px)));
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(length_um) + 1e-9)));
  const std::string label = fixed_text(length_um, decimals) + " um";
  const int label_width = text_width(label, 0.45);
  const int left = std::max(map.x + 180, map.br().x - label_width - 8 - length_px);  // beside the word, never on it
  cv::rectangle(page, cv::Rect(left, y - 7, length_px, 4), kInk, cv::FILLED);
  put_text(page, label, {left + length_px + 8, y}, 0.45, kInk);
}

PreviewText preview_text(const ResultData& data, const HeightSummary& summary) {
  long tenths = std::lround(summary.valid_fraction() * 1000);
  if (summary.valid < summary.points) tenths = std::min(tenths, 999L);  // 100 % means all
  PreviewText text;
  text.title = result_title(data);
  text.subtitle = (data.recipe_id.empty() ? "" : "recipe " + data.recipe_id + ", ") +
                  std::to_string(data.step_summary.steps) + " slices, window " + std::to_string(data.focus.window_px) +
                  " px, " + std::string(peak_method_name(data.peak)) + ", " + std::to_string(tenths / 10) + "." +
                  std::to_string(tenths % 10) + " % valid";
  text.simulated = data.simulated;
  text.pitch_x_um = data.pixel_pitch_x_um.value_or(0.0);
  return text;
}

}  // namespace

std::string encode_preview_png(const HeightMap& map, const HeightSummary& summary, const PreviewText& text) {
  try {
    const ColourRange limits = colour_limits(summary);
    const cv::Mat picture = coloured(resample(map), limits);
    // Maps that are narrow still get a page wide enough for their text.
    const int map_space = std::max(picture.cols, kMinMapSide);
    const int map_height = std::max(picture.rows, kMinBarHeight);
    cv::Mat page(kHeaderHeight + map_height + kFooterHeight, kMargin + map_space + kBarSpace, CV_8UC3, kBackground);
    const cv::Rect place(kMargin, kHeaderHeight, picture.cols, picture.rows);
    picture.copyTo(page(place));
    cv::rectangle(page, cv::Rect(place.x - 1, place.y - 1, place.width + 2, place.height + 2), kPaleInk);
    draw_page_header(page, text.title, text.subtitle, text.simulated, kMargin);
    const cv::Rect frame(kMargin, kHeaderHeight, picture.cols, map_height);
    draw_colour_bar(page, frame, limits, !summary.height);
    draw_footer(page, frame, text, text.pitch_x_um * map.height_m.width() / picture.cols);
    return png_bytes(page);
  } catch (const cv::Exception& failure) {
    throw Error(ErrorCode::kInternal, std::string("the preview could not be drawn: ") + failure.what());
  }
}

std::string preview_file(const ExportInput& input) {
  const HeightSummary& summary = input.summary.get();
  return encode_preview_png(input.map, summary, preview_text(input.data, summary));
}

}  // namespace fvd
