#include "drivers/aravis/frame_check.hpp"

#include <cstdio>
#include <cstring>

namespace fvd {

namespace {

/// "BayerRG8", or "0x01080009" for a format that fvd does not know.
std::string format_name(ArvPixelFormat pfnc) {
  for (const SensorFormat format : kAllSensorFormats) {
    if (sensor_format_info(format).pfnc == pfnc) return std::string(sensor_format_info(format).name);
  }
  char text[16];
  std::snprintf(text, sizeof text, "0x%08X", static_cast<unsigned>(pfnc));
  return text;
}

/// Bytes after every line. Chunk data of GigE Vision 1.x says nothing of its image.
std::size_t line_padding(ArvBuffer* buffer) {
  if (arv_buffer_get_payload_type(buffer) == ARV_BUFFER_PAYLOAD_TYPE_CHUNK_DATA) return 0;
  gint x_padding = 0;
  gint y_padding = 0;
  arv_buffer_get_image_padding(buffer, &x_padding, &y_padding);
  return x_padding > 0 ? static_cast<std::size_t>(x_padding) : 0;
}

/// Why the leader's image is another than the configured one; empty if it is the same.
std::string difference(ArvBuffer* buffer, const CameraSettings& settings) {
  if (arv_buffer_get_n_parts(buffer) != 1) {
    return "a buffer of " + std::to_string(arv_buffer_get_n_parts(buffer)) + " parts came, one image was expected";
  }
  const ArvPixelFormat format = arv_buffer_get_image_pixel_format(buffer);
  const SensorFormatInfo expected = sensor_format_info(settings.pixel_format);
  if (format != expected.pfnc) {
    return "a frame of pixel format " + format_name(format) + " came, " + std::string(expected.name) + " is set";
  }
  const int width = arv_buffer_get_image_width(buffer);
  const int height = arv_buffer_get_image_height(buffer);
  if (width == settings.width && height == settings.height) return {};
  return "a frame of " + std::to_string(width) + " x " + std::to_string(height) + " pixels came, " +
         std::to_string(settings.width) + " x " + std::to_string(settings.height) + " is set";
}

}  // namespace

FrameStatus check_frame(ArvBuffer* buffer, const CameraSettings& settings, std::string& refusal) {
  if (arv_buffer_get_status(buffer) != ARV_BUFFER_STATUS_SUCCESS) return FrameStatus::kIncomplete;
  const auto payload = arv_buffer_get_payload_type(buffer);
  switch (payload) {
    case ARV_BUFFER_PAYLOAD_TYPE_IMAGE:
    case ARV_BUFFER_PAYLOAD_TYPE_EXTENDED_CHUNK_DATA:
      refusal = difference(buffer, settings);
      break;
    case ARV_BUFFER_PAYLOAD_TYPE_CHUNK_DATA:
      refusal.clear();
      break;
    default:
      refusal = "payload of type " + std::to_string(payload) + " came, an image was expected";
  }
  if (!refusal.empty()) return FrameStatus::kWrongGeometry;
  const std::size_t image = sensor_image_bytes(settings.pixel_format, settings.width, settings.height);
  const std::size_t padding = line_padding(buffer);
  const auto lines = static_cast<std::size_t>(settings.height);
  std::size_t bytes = 0;
  arv_buffer_get_data(buffer, &bytes);
  // Aravis calls a frame complete that is longer or shorter than configured. The last line may do without its padding.
  if (bytes < image + padding * (lines - 1)) {
    refusal = "a frame of " + std::to_string(bytes) + " bytes came, its image takes " +
              std::to_string(image + padding * (lines - 1));
  } else if (padding > 0 && image % lines != 0) {
    refusal = "a frame came with padded lines that do not end at a byte";
  }
  return refusal.empty() ? FrameStatus::kOk : FrameStatus::kWrongGeometry;
}

std::span<const std::byte> wire_image(ArvBuffer* buffer, const CameraSettings& settings) {
  std::size_t bytes = 0;
  // The memory is the pool's, and this program's until the buffer is given back.
  auto* data = static_cast<std::byte*>(const_cast<void*>(arv_buffer_get_data(buffer, &bytes)));
  const std::size_t image = sensor_image_bytes(settings.pixel_format, settings.width, settings.height);
  if (const std::size_t padding = line_padding(buffer); padding > 0) {
    const std::size_t line = image / static_cast<std::size_t>(settings.height);
    for (std::size_t y = 1; y < static_cast<std::size_t>(settings.height); ++y) {
      std::memmove(data + y * line, data + y * (line + padding), line);
    }
  }
  return {data, image};
}

}  // namespace fvd
