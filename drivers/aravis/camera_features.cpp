#include "drivers/aravis/camera_features.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <memory>
#include <sstream>
#include <vector>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "drivers/aravis/gobject.hpp"

namespace fvd {

namespace {

/// Cameras round exposure to their line time, gain to their steps; further away than this it is another setting.
double exposure_tolerance_us(double asked_us) { return std::max(0.01 * asked_us, 20.0); }
constexpr double kGainTolerance_db = 0.3;
constexpr double kRateTolerance = 0.02;

/// So many that no limit is written with an exponent.
constexpr int kDigits = 12;

std::string number(double value) {
  std::ostringstream text;
  text << std::setprecision(kDigits) << value;
  return text.str();
}

std::string range(double min, double max) { return number(min) + " to " + number(max); }

}  // namespace

void CameraFeatures::refuse(const std::string& what) const {
  throw Error(ErrorCode::kCameraSettings, "the camera at " + where_ + ": " + what);
}

bool CameraFeatures::available(const char* feature) const {
  return arv_camera_is_feature_available(camera_, feature, nullptr) != FALSE;
}

gint64 CameraFeatures::integer(const char* feature) const {
  GErrorSlot error;
  const gint64 value = arv_camera_get_integer(camera_, feature, error.out());
  error.check("the camera at " + where_ + " does not tell " + feature);
  return value;
}

gint64 CameraFeatures::increment(const char* feature) const {
  GErrorSlot error;
  const gint64 step = arv_camera_get_integer_increment(camera_, feature, error.out());
  return error.failed() ? 1 : std::max<gint64>(1, step);
}

void CameraFeatures::sensor_size(int& width, int& height) const {
  GErrorSlot error;
  arv_camera_get_sensor_size(camera_, &width, &height, error.out());
  if (!error.failed() && width > 0 && height > 0) return;
  width = static_cast<int>(integer("WidthMax"));
  height = static_cast<int>(integer("HeightMax"));
}

void CameraFeatures::set_integer(const char* feature, gint64 value) const {
  GErrorSlot error;
  gint64 min = 0;
  gint64 max = 0;
  arv_camera_get_integer_bounds(camera_, feature, &min, &max, error.out());
  error.check("the camera at " + where_ + " does not tell the range of " + feature);
  const gint64 step = increment(feature);
  const std::string accepted =
      std::to_string(min) + " to " + std::to_string(max) + (step > 1 ? " in steps of " + std::to_string(step) : "");
  // Aravis checks the range at best, never the increment.
  if (value < min || value > max || (value - min) % step != 0) {
    refuse(std::string(feature) + " = " + std::to_string(value) + " is refused; accepted: " + accepted);
  }
  arv_camera_set_integer(camera_, feature, value, error.out());
  error.check("the camera at " + where_ + " refuses " + feature + " = " + std::to_string(value) +
              "; accepted: " + accepted);
  const gint64 got = integer(feature);
  if (got == value) return;
  refuse(std::string(feature) + " = " + std::to_string(value) + " was asked for and reads back " + std::to_string(got) +
         "; accepted: " + accepted);
}

CameraSettings CameraFeatures::apply_shape(const CameraSettings& settings) const {
  CameraSettings in_force = settings;
  GErrorSlot error;
  arv_camera_set_acquisition_mode(camera_, ARV_ACQUISITION_MODE_CONTINUOUS, error.out());
  error.check("the camera at " + where_ + " has no continuous acquisition");
  switch_chunks_off();
  set_pixel_format(settings.pixel_format);
  set_region(settings, in_force);
  return in_force;
}

void CameraFeatures::apply_timing(const CameraSettings& settings, CameraSettings& in_force) const {
  in_force.exposure_us = set_exposure_us(settings.exposure_us);
  // A gain in the camera's own unit is never taken for one in dB.
  if (!available("Gain") && available("GainRaw")) {
    in_force.gain_raw = set_gain_raw(settings);
  } else {
    if (settings.gain_raw >= 0) refuse("it has no GainRaw; use gain_db");
    in_force.gain_db = set_gain_db(settings.gain_db);
  }
  if (settings.trigger == TriggerMode::kFreeRun) in_force.frame_rate_hz = set_frame_rate_hz(settings.frame_rate_hz);
  set_trigger(settings);
  in_force.trigger = settings.trigger;
  in_force.trigger_line = settings.trigger_line;
}

void CameraFeatures::set_pixel_format(SensorFormat format) const {
  const std::string name(sensor_format_info(format).name);
  GErrorSlot error;
  guint count = 0;
  const std::unique_ptr<const char*, decltype(&g_free)> names(
      arv_camera_dup_available_pixel_formats_as_strings(camera_, &count, error.out()), &g_free);
  error.check("the camera at " + where_ + " does not list its pixel formats");
  const std::vector<std::string> accepted(names.get(), names.get() + count);
  if (std::find(accepted.begin(), accepted.end(), name) == accepted.end()) {
    std::string list;
    for (const std::string& each : accepted) list += (list.empty() ? "" : ", ") + each;
    refuse("PixelFormat = " + name + " is refused; accepted: " + list);
  }
  arv_camera_set_pixel_format_from_string(camera_, name.c_str(), error.out());
  error.check("the camera at " + where_ + " refuses PixelFormat = " + name);
  const char* got = arv_camera_get_pixel_format_as_string(camera_, error.out());
  error.check("the camera at " + where_ + " does not tell its PixelFormat");
  if (name != got) refuse("PixelFormat = " + name + " was asked for and reads back " + got);
}

void CameraFeatures::set_region(const CameraSettings& settings, CameraSettings& in_force) const {
  const bool movable = arv_camera_is_region_offset_available(camera_, nullptr) != FALSE;
  if (!movable && (settings.offset_x != 0 || settings.offset_y != 0)) {
    refuse("its region cannot be moved; only offset 0 is possible");
  }
  // Offsets to 0 first: they limit the size.
  if (movable) {
    set_integer("OffsetX", 0);
    set_integer("OffsetY", 0);
  }
  int sensor_width = 0;
  int sensor_height = 0;
  sensor_size(sensor_width, sensor_height);
  if (settings.width == 0) in_force.width = largest("Width", sensor_width - settings.offset_x);
  if (settings.height == 0) in_force.height = largest("Height", sensor_height - settings.offset_y);
  set_integer("Width", in_force.width);
  set_integer("Height", in_force.height);
  if (!movable) return;
  set_integer("OffsetX", settings.offset_x);
  set_integer("OffsetY", settings.offset_y);
}

/// Of the values that the feature accepts, the largest that fits.
int CameraFeatures::largest(const char* feature, gint64 room) const {
  GErrorSlot error;
  gint64 min = 0;
  gint64 max = 0;
  arv_camera_get_integer_bounds(camera_, feature, &min, &max, error.out());
  error.check("the camera at " + where_ + " does not tell the range of " + feature);
  return on_grid(feature, std::min(max, room));
}

int CameraFeatures::on_grid(const char* feature, gint64 room) const {
  GErrorSlot error;
  gint64 min = 0;
  gint64 max = 0;
  arv_camera_get_integer_bounds(camera_, feature, &min, &max, error.out());
  if (error.failed() || room < min) return static_cast<int>(room);
  const gint64 step = increment(feature);
  return static_cast<int>(min + (room - min) / step * step);
}

/// Chunks are not needed. A camera that keeps them on is taken with them.
void CameraFeatures::switch_chunks_off() const {
  if (!available("ChunkModeActive")) return;
  GErrorSlot error;
  if (arv_camera_get_boolean(camera_, "ChunkModeActive", error.out()) == FALSE || error.failed()) return;
  arv_camera_set_boolean(camera_, "ChunkModeActive", FALSE, error.out());
  if (error.failed()) spdlog::info("the camera at {} keeps its chunks: {}", where_, error.message());
}

double CameraFeatures::set_exposure_us(double exposure_us) const {
  GErrorSlot error;
  if (arv_camera_is_exposure_auto_available(camera_, nullptr) != FALSE) {
    arv_camera_set_exposure_time_auto(camera_, ARV_AUTO_OFF, error.out());
    error.check("the camera at " + where_ + " keeps ExposureAuto on");
  }
  // Aravis knows ExposureTime, ExposureTimeAbs and ExposureTimeRaw.
  double min = 0.0;
  double max = 0.0;
  arv_camera_get_exposure_time_bounds(camera_, &min, &max, error.out());
  error.check("the camera at " + where_ + " does not tell the range of ExposureTime");
  if (!(exposure_us >= min && exposure_us <= max)) {
    refuse("ExposureTime = " + number(exposure_us) + " us is refused; accepted: " + range(min, max) + " us");
  }
  arv_camera_set_exposure_time(camera_, exposure_us, error.out());
  error.check("the camera at " + where_ + " refuses ExposureTime = " + number(exposure_us) + " us");
  const double got = arv_camera_get_exposure_time(camera_, error.out());
  error.check("the camera at " + where_ + " does not tell its ExposureTime");
  if (std::abs(got - exposure_us) > exposure_tolerance_us(exposure_us)) {
    refuse("ExposureTime = " + number(exposure_us) + " us was asked for and reads back " + number(got) +
           "; accepted: " + range(min, max) + " us");
  }
  return got;
}

double CameraFeatures::set_gain_db(double gain_db) const {
  if (arv_camera_is_gain_available(camera_, nullptr) == FALSE) {
    if (gain_db != 0.0) refuse("it has no Gain; use gain_db 0");
    return 0.0;
  }
  GErrorSlot error;
  if (arv_camera_is_gain_auto_available(camera_, nullptr) != FALSE) {
    arv_camera_set_gain_auto(camera_, ARV_AUTO_OFF, error.out());
    error.check("the camera at " + where_ + " keeps GainAuto on");
  }
  double min = 0.0;
  double max = 0.0;
  arv_camera_get_gain_bounds(camera_, &min, &max, error.out());
  error.check("the camera at " + where_ + " does not tell the range of Gain");
  // The default of recipes means "the least"; not every camera counts its gain from 0.
  if (gain_db == 0.0) gain_db = std::clamp(gain_db, min, max);
  if (!(gain_db >= min && gain_db <= max)) {
    refuse("Gain = " + number(gain_db) + " dB is refused; accepted: " + range(min, max) + " dB");
  }
  arv_camera_set_gain(camera_, gain_db, error.out());
  error.check("the camera at " + where_ + " refuses Gain = " + number(gain_db) + " dB");
  const double got = arv_camera_get_gain(camera_, error.out());
  error.check("the camera at " + where_ + " does not tell its Gain");
  if (std::abs(got - gain_db) > kGainTolerance_db) {
    refuse("Gain = " + number(gain_db) + " dB was asked for and reads back " + number(got) +
           "; accepted: " + range(min, max) + " dB");
  }
  return got;
}

int CameraFeatures::set_gain_raw(const CameraSettings& settings) const {
  GErrorSlot error;
  gint64 min = 0;
  gint64 max = 0;
  arv_camera_get_integer_bounds(camera_, "GainRaw", &min, &max, error.out());
  error.check("the camera at " + where_ + " does not tell the range of GainRaw");
  if (settings.gain_db != 0.0) {
    refuse("its gain is GainRaw, in a unit of its own, and not in dB; use gain_raw, accepted: " + std::to_string(min) +
           " to " + std::to_string(max) + ", and gain_db 0");
  }
  if (arv_camera_is_gain_auto_available(camera_, nullptr) != FALSE) {
    arv_camera_set_gain_auto(camera_, ARV_AUTO_OFF, error.out());
    error.check("the camera at " + where_ + " keeps GainAuto on");
  }
  const gint64 asked = settings.gain_raw < 0 ? min : settings.gain_raw;
  set_integer("GainRaw", asked);
  return static_cast<int>(asked);
}

double CameraFeatures::set_frame_rate_hz(double frame_rate_hz) const {
  GErrorSlot error;
  double min = 0.0;
  double max = 0.0;
  arv_camera_get_frame_rate_bounds(camera_, &min, &max, error.out());
  error.check("the camera at " + where_ + " has no AcquisitionFrameRate; it cannot run free at a rate of its own");
  const double asked = frame_rate_hz > 0.0 ? frame_rate_hz : max;
  if (!(asked >= min && asked <= max)) {
    refuse("AcquisitionFrameRate = " + number(asked) +
           " Hz is refused; accepted with this exposure and region: " + range(min, max) + " Hz");
  }
  arv_camera_set_frame_rate(camera_, asked, error.out());
  error.check("the camera at " + where_ + " refuses AcquisitionFrameRate = " + number(asked) + " Hz");
  const double got = arv_camera_get_frame_rate(camera_, error.out());
  error.check("the camera at " + where_ + " does not tell its AcquisitionFrameRate");
  if (std::abs(got - asked) > kRateTolerance * asked) {
    refuse("AcquisitionFrameRate = " + number(asked) + " Hz was asked for and reads back " + number(got) + " Hz");
  }
  return got;
}

void CameraFeatures::set_trigger(const CameraSettings& settings) const {
  GErrorSlot error;
  if (settings.trigger == TriggerMode::kFreeRun) {
    arv_camera_clear_triggers(camera_, error.out());
    error.check("the camera at " + where_ + " does not leave its trigger mode");
    // What clear_triggers leaves of the rate differs between cameras.
    if (available("AcquisitionFrameRateEnable")) {
      arv_camera_set_boolean(camera_, "AcquisitionFrameRateEnable", TRUE, error.out());
      error.check("the camera at " + where_ + " refuses AcquisitionFrameRateEnable");
    }
    return;
  }
  const std::string source = settings.trigger == TriggerMode::kSoftware ? "Software" : settings.trigger_line;
  // arv_camera_set_trigger() turns every trigger off in between: a camera that acquires then exposes once by itself,
  // and takes no trigger until that is over.
  bool taken = false;
  if (available("TriggerMode") && text("TriggerMode") == "On") {
    GErrorSlot refused;
    if (text("TriggerSource") != source) arv_camera_set_string(camera_, "TriggerSource", source.c_str(), refused.out());
    taken = !refused.failed();
  }
  if (!taken) {
    arv_camera_set_trigger(camera_, source.c_str(), error.out());
    error.check("the camera at " + where_ + " refuses TriggerSource = " + source);
  }
  const auto mode = text("TriggerMode");
  const auto got = text("TriggerSource");
  if (mode && mode != "On") refuse("TriggerMode = On was asked for and reads back " + *mode);
  if (got && got != source) refuse("TriggerSource = " + source + " was asked for and reads back " + *got);
}

/// What the feature reads; nothing if the camera lets it be written only. Whether such a trigger is right, frames tell.
std::optional<std::string> CameraFeatures::text(const char* feature) const {
  GErrorSlot error;
  const char* value = arv_camera_get_string(camera_, feature, error.out());
  if (error.is_connection_loss()) error.check("the camera at " + where_ + " does not tell " + feature);
  if (error.failed() || value == nullptr) return std::nullopt;
  return value;
}

}  // namespace fvd
