#include "daemon/export/preview_hub.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include <glib.h>
#include <nlohmann/json.hpp>

#include "core/focus/grey_statistics.hpp"
#include "core/scan/autofocus.hpp"
#include "daemon/export/image_png.hpp"

namespace fvd {

namespace {

constexpr int kMaxPictureWidth = 640;
constexpr int kMaxPictureHeight = 480;
constexpr std::chrono::milliseconds kMinPictureInterval{200};
constexpr std::chrono::seconds kViewerTimeout{3};

template <typename Pixel>
Plane<std::uint8_t> scaled(PlaneView<const Pixel> image, int factor, int shift) {
  Plane<std::uint8_t> out(image.width / factor, image.height / factor);
  const auto area = static_cast<unsigned>(factor * factor);
  for (int y = 0; y < out.height(); ++y) {
    for (int x = 0; x < out.width(); ++x) {
      unsigned sum = 0;
      for (int v = 0; v < factor; ++v) {
        const Pixel* row = image.row(y * factor + v) + x * factor;
        for (int u = 0; u < factor; ++u) sum += row[u];
      }
      out.at(x, y) = static_cast<std::uint8_t>(sum / area >> shift);
    }
  }
  return out;
}

}  // namespace

PreviewPicture make_preview(const ImageView& image, double z_um) {
  const int factor = std::max({1, (image.width + kMaxPictureWidth - 1) / kMaxPictureWidth,
                               (image.height + kMaxPictureHeight - 1) / kMaxPictureHeight});
  const int shift = significant_bits(image.format) - 8;
  PreviewPicture picture;
  picture.pixels = bytes_per_pixel(image.format) == 1 ? scaled(image.as<std::uint8_t>(), factor, 0)
                                                      : scaled(image.as<std::uint16_t>(), factor, shift);
  picture.z_um = z_um;
  picture.focus = mean_focus(image, central_region(image.width, image.height));
  picture.saturated_fraction = grey_statistics(image).saturated_fraction;
  return picture;
}

std::string preview_json(const PreviewPicture& picture) {
  const std::string png = encode_image_png(image_view(picture.pixels.view(), PixelFormat::kMono8));
  const std::unique_ptr<char, decltype(&g_free)> base64(
      g_base64_encode(reinterpret_cast<const guchar*>(png.data()), png.size()), &g_free);
  return nlohmann::ordered_json{{"seq", picture.seq},
                                {"width_px", picture.pixels.width()},
                                {"height_px", picture.pixels.height()},
                                {"z_um", picture.z_um},
                                {"focus", picture.focus},
                                {"saturated_fraction", picture.saturated_fraction},
                                {"png_base64", base64.get()}}
      .dump();
}

void PreviewHub::offer(const ImageView& image, double z_um) {
  const HostTime now = HostClock::now();
  if (now > wanted_until_.load() || !mutex_.try_lock()) return;
  const bool recent = newest_ && now - taken_ < kMinPictureInterval;
  mutex_.unlock();
  if (recent) return;
  PreviewPicture picture = make_preview(image, z_um);
  if (!mutex_.try_lock()) return;
  // Nothing here throws.
  picture.seq = ++seq_;
  newest_ = std::move(picture);
  taken_ = now;
  mutex_.unlock();
}

std::optional<std::string> PreviewHub::newest() {
  wanted_until_ = HostClock::now() + kViewerTimeout;
  const MutexLock lock(mutex_);
  if (!newest_) return std::nullopt;
  return preview_json(*newest_);
}

void PreviewHub::clear() {
  const MutexLock lock(mutex_);
  newest_.reset();
}

}  // namespace fvd
