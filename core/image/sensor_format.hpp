#pragma once

/// Pixel formats as cameras send them, and what fvd makes of them.

#include <array>
#include <cstddef>
#include <string_view>

#include "core/image/image.hpp"

namespace fvd {

/// PFNC formats that fvd accepts. The two letters after Bayer are the colours of the first two pixels of row 0.
enum class SensorFormat {
  kMono8,
  kMono10,  ///< 16 bit per pixel, values at the lower end
  kMono12,  ///< likewise
  kMono16,
  kMono10p,       ///< 4 pixels in 5 bytes, least significant bits first
  kMono12p,       ///< 2 pixels in 3 bytes, least significant bits first
  kMono12Packed,  ///< 2 pixels in 3 bytes, GigE Vision's own order
  kBayerRG8,
  kBayerGR8,
  kBayerGB8,
  kBayerBG8,
  kBayerRG12,  ///< 16 bit per pixel, values at the lower end; as the three below
  kBayerGR12,
  kBayerGB12,
  kBayerBG12,
};
inline constexpr std::array kAllSensorFormats{
    SensorFormat::kMono8,     SensorFormat::kMono10,    SensorFormat::kMono12,       SensorFormat::kMono16,
    SensorFormat::kMono10p,   SensorFormat::kMono12p,   SensorFormat::kMono12Packed, SensorFormat::kBayerRG8,
    SensorFormat::kBayerGR8,  SensorFormat::kBayerGB8,  SensorFormat::kBayerBG8,     SensorFormat::kBayerRG12,
    SensorFormat::kBayerGR12, SensorFormat::kBayerGB12, SensorFormat::kBayerBG12};

/// Which values of a colour mosaic are measured; every pixel of the slice gets one.
enum class BayerUse {
  kGreen,      ///< green pixels unchanged, others the mean of their four green neighbours: sharpest, one wavelength
  kLuminance,  ///< (R + 2 G + B) / 4 of the pixel and those right and below: more light; shifted by half a pixel
};

struct SensorFormatInfo {
  std::string_view name;  ///< PFNC
  unsigned pfnc;          ///< PFNC value
  int bits_per_pixel;     ///< on the wire, padding included
  int bits;               ///< significant bits of a value
  bool bayer;
};

/// Source of names and values: GenICam Pixel Format Naming Convention 2.4, PFNC value list; Mono12Packed: GigE Vision.
[[nodiscard]] constexpr SensorFormatInfo sensor_format_info(SensorFormat format) {
  switch (format) {
    case SensorFormat::kMono8:
      return {"Mono8", 0x01080001U, 8, 8, false};
    case SensorFormat::kMono10:
      return {"Mono10", 0x01100003U, 16, 10, false};
    case SensorFormat::kMono12:
      return {"Mono12", 0x01100005U, 16, 12, false};
    case SensorFormat::kMono16:
      return {"Mono16", 0x01100007U, 16, 16, false};
    case SensorFormat::kMono10p:
      return {"Mono10p", 0x010A0046U, 10, 10, false};
    case SensorFormat::kMono12p:
      return {"Mono12p", 0x010C0047U, 12, 12, false};
    case SensorFormat::kMono12Packed:
      return {"Mono12Packed", 0x010C0006U, 12, 12, false};
    case SensorFormat::kBayerGR8:
      return {"BayerGR8", 0x01080008U, 8, 8, true};
    case SensorFormat::kBayerRG8:
      return {"BayerRG8", 0x01080009U, 8, 8, true};
    case SensorFormat::kBayerGB8:
      return {"BayerGB8", 0x0108000AU, 8, 8, true};
    case SensorFormat::kBayerBG8:
      return {"BayerBG8", 0x0108000BU, 8, 8, true};
    case SensorFormat::kBayerGR12:
      return {"BayerGR12", 0x01100010U, 16, 12, true};
    case SensorFormat::kBayerRG12:
      return {"BayerRG12", 0x01100011U, 16, 12, true};
    case SensorFormat::kBayerGB12:
      return {"BayerGB12", 0x01100012U, 16, 12, true};
    case SensorFormat::kBayerBG12:
      return {"BayerBG12", 0x01100013U, 16, 12, true};
  }
  return {"Mono8", 0x01080001U, 8, 8, false};
}

/// Bytes of an image on the wire; packed formats run on from row to row, as PFNC has it.
[[nodiscard]] constexpr std::size_t sensor_image_bytes(SensorFormat format, int width, int height) {
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  return (pixels * static_cast<std::size_t>(sensor_format_info(format).bits_per_pixel) + 7) / 8;
}

/// The format of the slices made of `format`. significant_bits: 10 or 12 for a 16-bit format whose values fill the
/// upper bits; 0 = as the format says.
[[nodiscard]] constexpr PixelFormat slice_format(SensorFormat format, int significant_bits) {
  const SensorFormatInfo info = sensor_format_info(format);
  switch (info.bits == 16 && significant_bits != 0 ? significant_bits : info.bits) {
    case 8:
      return PixelFormat::kMono8;
    case 10:
      return PixelFormat::kMono10;
    case 12:
      return PixelFormat::kMono12;
    default:
      return PixelFormat::kMono16;
  }
}

}  // namespace fvd
