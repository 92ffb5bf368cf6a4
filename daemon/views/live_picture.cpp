#include "daemon/views/live_picture.hpp"

#include "daemon/export/image_jpeg.hpp"
#include "daemon/export/preview_hub.hpp"

namespace fvd {

namespace {

constexpr int kQuality = 80;

}  // namespace

std::shared_ptr<const LiveJpeg> LivePicture::other_than(std::uint64_t after) {
  const std::shared_ptr<const PreviewPicture> picture = source_.newest_picture();
  if (!picture || picture->seq == after) return nullptr;
  const MutexLock lock(mutex_);
  if (encoded_ && encoded_->seq == picture->seq) return encoded_;
  auto made = std::make_shared<LiveJpeg>();
  made->seq = picture->seq;
  made->jpeg = encode_grey_jpeg(picture->pixels.view(), kQuality);
  made->image_width_px = picture->image_width_px;
  made->image_height_px = picture->image_height_px;
  made->z_um = picture->z_um;
  made->focus = picture->focus;
  made->saturated_fraction = picture->saturated_fraction;
  encoded_ = made;
  return made;
}

}  // namespace fvd
