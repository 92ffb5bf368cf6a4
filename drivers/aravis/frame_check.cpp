#include "drivers/aravis/frame_check.hpp"

namespace fvd {

FrameStatus check_frame(ArvBuffer* buffer, const CameraSettings& settings) {
  if (arv_buffer_get_status(buffer) != ARV_BUFFER_STATUS_SUCCESS) return FrameStatus::kIncomplete;
  const auto payload = arv_buffer_get_payload_type(buffer);
  if (payload != ARV_BUFFER_PAYLOAD_TYPE_IMAGE && payload != ARV_BUFFER_PAYLOAD_TYPE_EXTENDED_CHUNK_DATA) {
    return FrameStatus::kWrongGeometry;
  }
  if (arv_buffer_get_n_parts(buffer) != 1 ||
      arv_buffer_get_image_pixel_format(buffer) != sensor_format_info(settings.pixel_format).pfnc ||
      arv_buffer_get_image_width(buffer) != settings.width || arv_buffer_get_image_height(buffer) != settings.height) {
    return FrameStatus::kWrongGeometry;
  }
  gint x_padding = 0;
  gint y_padding = 0;
  arv_buffer_get_image_padding(buffer, &x_padding, &y_padding);
  std::size_t bytes = 0;
  arv_buffer_get_data(buffer, &bytes);
  // Aravis calls a frame complete that is longer or shorter than configured.
  return x_padding == 0 && bytes >= sensor_image_bytes(settings.pixel_format, settings.width, settings.height)
             ? FrameStatus::kOk
             : FrameStatus::kWrongGeometry;
}

std::span<const std::byte> wire_image(ArvBuffer* buffer, const CameraSettings& settings) {
  std::size_t bytes = 0;
  const void* data = arv_buffer_get_data(buffer, &bytes);
  // Chunks may follow the image.
  return {static_cast<const std::byte*>(data),
          sensor_image_bytes(settings.pixel_format, settings.width, settings.height)};
}

}  // namespace fvd
