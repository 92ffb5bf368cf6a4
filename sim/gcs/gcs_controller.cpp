#include "sim/gcs/gcs_controller.hpp"

#include <cmath>
#include <cstdint>
#include <sstream>
#include <utility>

namespace fvd::sim {

namespace {

constexpr char kAskMotion = '\x05';
constexpr char kStopAll = '\x18';
constexpr double kUmPerMm = 1000.0;
constexpr std::size_t kMaxCommandBytes = 256;

namespace code {
constexpr int kSyntax = 1;
constexpr int kUnknownCommand = 2;
constexpr int kTooLong = 3;
constexpr int kNoReferenceOrServo = 5;
constexpr int kPositionOutOfLimits = 7;
constexpr int kVelocityOutOfLimits = 8;
constexpr int kStopped = 10;
constexpr int kInvalidAxis = 15;
constexpr int kOutOfRange = 17;
}  // namespace code

std::string text(double value) {
  std::ostringstream out;
  out.precision(6);
  out << std::fixed << value;
  return out.str();
}

}  // namespace

GcsController::GcsController(AxisModel& axis, double travel_mm) : axis_(axis), travel_mm_(travel_mm) {}

std::string GcsController::take(std::string_view bytes) {
  const MutexLock lock(mutex_);
  const HostTime now = HostClock::now();
  std::string answers;
  for (const char byte : bytes) {
    if (byte == kAskMotion) {
      answers += axis_.moving(now) ? "1\n" : "0\n";
    } else if (byte == kStopAll) {
      stop(now);
    } else if (byte == '\n') {
      answers += execute(input_, now);
      input_.clear();
    } else if (input_.size() < kMaxCommandBytes) {
      input_ += byte;
    } else {
      error_ = code::kTooLong;
      input_.clear();
    }
  }
  return answers;
}

void GcsController::line_closed() {
  const MutexLock lock(mutex_);
  input_.clear();
}

std::string GcsController::execute(const std::string& line, HostTime now) {
  std::istringstream words(line);
  std::string command;
  std::string axis;
  std::string excess;
  words >> command;
  if (command.empty()) return {};
  if (command == "*IDN?") return "(c)2015 Physik Instrumente (PI) GmbH & Co. KG, C-863.11 (simulated), 0, 1.0\n";
  if (command == "SAI?") return "1\n";
  if (command == "ERR?") return std::to_string(std::exchange(error_, 0)) + '\n';
  if (words >> axis && axis != "1") {
    error_ = code::kInvalidAxis;
    return {};
  }
  if (command.back() == '?') return answer(command, now);
  double value = 0.0;
  const bool has_value = static_cast<bool>(words >> value);
  words.clear();
  if (words >> excess) {
    error_ = code::kSyntax;
  } else if (command == "HLT" || command == "STP") {
    stop(now);
  } else if (command == "FRF") {
    if (servo_) axis_.home(now);
    if (!servo_) error_ = code::kNoReferenceOrServo;
  } else if (!has_value) {
    error_ = command == "SVO" || command == "MOV" ? code::kSyntax : code::kUnknownCommand;
  } else if (const int failed = set(command, value, now); failed != 0) {
    error_ = failed;
  }
  return {};
}

std::string GcsController::answer(const std::string& question, HostTime now) {
  const double um_per_step = 1.0 / axis_.parameters().steps_per_um;
  std::string value;
  if (question == "SVO?") value = servo_ ? "1" : "0";
  if (question == "FRF?") value = axis_.homed(now) ? "1" : "0";
  if (question == "ONT?") value = axis_.in_position(now) ? "1" : "0";
  if (question == "POS?") value = text(axis_.encoder_steps(now) * um_per_step / kUmPerMm);
  if (question == "TMN?") value = text(-travel_mm_);
  if (question == "TMX?") value = text(travel_mm_);
  if (question == "VEL?") value = text(velocity_mm_per_s_);
  if (!value.empty()) return "1=" + value + '\n';
  error_ = code::kUnknownCommand;
  return {};
}

int GcsController::set(const std::string& command, double value, HostTime now) {
  if (command == "SVO") {
    servo_ = value != 0.0;
    if (!servo_) axis_.stop(now);
    return 0;
  }
  if (command == "VEL") {
    if (!(value > 0.0 && value <= 100.0)) return code::kVelocityOutOfLimits;
    velocity_mm_per_s_ = value;
    return 0;
  }
  if (command == "ACC" || command == "DEC") {
    if (!(value > 0.0)) return code::kOutOfRange;
    (command == "ACC" ? acceleration_mm_per_s2_ : deceleration_mm_per_s2_) = value;
    return 0;
  }
  if (command != "MOV") return code::kUnknownCommand;
  if (!servo_ || !axis_.homed(now)) return code::kNoReferenceOrServo;
  if (std::abs(value) > travel_mm_) return code::kPositionOutOfLimits;
  move(value, now);
  return 0;
}

void GcsController::move(double target_mm, HostTime now) {
  if (refused_moves_ > 0) {
    --refused_moves_;
    return;
  }
  const double steps_per_mm = axis_.parameters().steps_per_um * kUmPerMm;
  axis_.move_to(now, static_cast<std::int32_t>(std::lround(target_mm * steps_per_mm)),
                velocity_mm_per_s_ * steps_per_mm, acceleration_mm_per_s2_ * steps_per_mm,
                deceleration_mm_per_s2_ * steps_per_mm);
  ++moves_;
}

void GcsController::stop(HostTime now) {
  if (refused_stops_ > 0) {
    --refused_stops_;
    error_ = code::kUnknownCommand;
    return;
  }
  if (axis_.moving(now)) axis_.stop(now);
  error_ = code::kStopped;
}

void GcsController::raise_alarm(int code) {
  const MutexLock lock(mutex_);
  axis_.stop(HostClock::now());
  servo_ = false;
  error_ = code;
}

void GcsController::refuse_moves(int count) {
  const MutexLock lock(mutex_);
  refused_moves_ = count;
}

void GcsController::refuse_stops(int count) {
  const MutexLock lock(mutex_);
  refused_stops_ = count;
}

int GcsController::moves() const {
  const MutexLock lock(mutex_);
  return moves_;
}

}  // namespace fvd::sim
