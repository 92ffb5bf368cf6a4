#include "daemon/export/image_jpeg.hpp"

#include <memory>
#include <new>

#include <turbojpeg.h>

#include "core/base/error.hpp"

namespace fvd {

namespace {

struct EncoderCloser {
  void operator()(void* encoder) const noexcept { tjDestroy(encoder); }
};

/// The bytes that libturbojpeg allocates.
struct JpegBytes {
  JpegBytes() = default;
  JpegBytes(const JpegBytes&) = delete;
  JpegBytes& operator=(const JpegBytes&) = delete;
  ~JpegBytes() { tjFree(data); }

  unsigned char* data = nullptr;
  unsigned long size = 0;  // NOLINT(google-runtime-int): the library's type
};

}  // namespace

std::string encode_grey_jpeg(PlaneView<const std::uint8_t> pixels, int quality) {
  const std::unique_ptr<void, EncoderCloser> encoder(tjInitCompress());
  if (!encoder) throw std::bad_alloc();
  JpegBytes bytes;
  const int failed = tjCompress2(encoder.get(), pixels.data, pixels.width, static_cast<int>(pixels.row_stride),
                                 pixels.height, TJPF_GRAY, &bytes.data, &bytes.size, TJSAMP_GRAY, quality, 0);
  if (failed != 0) {
    throw Error(ErrorCode::kInternal,
                std::string("libjpeg could not encode a picture: ") + tjGetErrorStr2(encoder.get()));
  }
  return {reinterpret_cast<const char*>(bytes.data), bytes.size};
}

}  // namespace fvd
