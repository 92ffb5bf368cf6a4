#include "daemon/export/preview_hub.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <glib.h>
#include <nlohmann/json.hpp>

#include "core/image/shrink.hpp"
#include "core/scan/autofocus.hpp"
#include "daemon/export/image_png.hpp"

namespace fvd {

namespace {

constexpr int kMaxPictureSide = 1280;
constexpr int kMaxPngWidth = 640;
constexpr int kMaxPngHeight = 480;
constexpr std::chrono::milliseconds kPictureInterval{100};
constexpr std::chrono::seconds kViewerTimeout{3};

}  // namespace

PreviewPicture make_preview(const ImageView& image, double z_um) {
  ShrunkImage shrunk = shrink(image, shrink_factor(image.width, image.height, kMaxPictureSide, kMaxPictureSide));
  PreviewPicture picture;
  picture.pixels = std::move(shrunk.pixels);
  picture.image_width_px = image.width;
  picture.image_height_px = image.height;
  picture.z_um = z_um;
  picture.focus = mean_focus(image, central_region(image.width, image.height));
  picture.saturated_fraction =
      static_cast<double>(shrunk.saturated) / (static_cast<double>(image.width) * image.height);
  return picture;
}

std::string preview_json(const PreviewPicture& picture) {
  const ImageView large = image_view(picture.pixels.view(), PixelFormat::kMono8);
  const Plane<std::uint8_t> pixels =
      shrink(large, shrink_factor(large.width, large.height, kMaxPngWidth, kMaxPngHeight)).pixels;
  const std::string png = encode_image_png(image_view(pixels.view(), PixelFormat::kMono8));
  const std::unique_ptr<char, decltype(&g_free)> base64(
      g_base64_encode(reinterpret_cast<const guchar*>(png.data()), png.size()), &g_free);
  return nlohmann::ordered_json{{"seq", picture.seq},           {"width_px", pixels.width()},
                                {"height_px", pixels.height()}, {"z_um", picture.z_um},
                                {"focus", picture.focus},       {"saturated_fraction", picture.saturated_fraction},
                                {"png_base64", base64.get()}}
      .dump();
}

void PicturePace::taken(HostTime now) { due_ = std::max(due_, now - kPictureInterval / 2) + kPictureInterval; }

void PreviewHub::offer(const ImageView& image, double z_um) {
  const HostTime now = HostClock::now();
  if (now > wanted_until_.load() || !mutex_.try_lock()) return;
  const bool is_due = pace_.is_due(now);
  mutex_.unlock();
  if (!is_due) return;
  const auto picture = std::make_shared<PreviewPicture>(make_preview(image, z_um));
  if (!mutex_.try_lock()) return;
  // Nothing here throws.
  picture->seq = ++seq_;
  newest_ = picture;
  pace_.taken(now);
  mutex_.unlock();
}

std::shared_ptr<const PreviewPicture> PreviewHub::take(const ImageView& image, double z_um) {
  const auto picture = std::make_shared<PreviewPicture>(make_preview(image, z_um));
  const MutexLock lock(mutex_);
  picture->seq = ++seq_;
  newest_ = picture;
  pace_.taken(HostClock::now());
  return picture;
}

std::shared_ptr<const PreviewPicture> PreviewHub::newest_picture() {
  wanted_until_ = HostClock::now() + kViewerTimeout;
  const MutexLock lock(mutex_);
  return newest_;
}

std::optional<std::string> PreviewHub::newest() {
  const auto picture = newest_picture();
  if (!picture) return std::nullopt;
  return preview_json(*picture);
}

void PreviewHub::clear() {
  const MutexLock lock(mutex_);
  newest_.reset();
  pace_ = {};
}

}  // namespace fvd
