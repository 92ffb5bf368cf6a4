#include "daemon/jobs/part_temperature.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include "daemon/base/unique_fd.hpp"

namespace fvd {

namespace {

constexpr double kLowest_c = -50.0;
constexpr double kHighest_c = 100.0;
/// The clocks of two machines that share a folder differ.
constexpr double kClockTolerance_s = 5.0;
constexpr std::size_t kMaxNumber_bytes = 64;

TemperatureReading unknown(const TemperatureConfig& source, const std::string& why) {
  return {std::nullopt, "the temperature is not known: " + source.file.string() + " " + why};
}

/// The one number of the text, with white space around it; nothing if that is not all there is.
std::optional<double> number_in(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n";
  const auto from = text.find_first_not_of(kSpace);
  if (from == std::string_view::npos) return std::nullopt;
  text = text.substr(from, text.find_last_not_of(kSpace) + 1 - from);
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number)) return std::nullopt;
  return number;
}

double age_s(int file, const struct stat& status, std::chrono::system_clock::time_point now) {
  struct statfs system {};
  if (::fstatfs(file, &system) == 0 && system.f_type == SYSFS_MAGIC) return 0.0;
  // The difference of whole numbers: seconds since 1970 in a double are 0.2 us apart.
  const std::chrono::nanoseconds changed =
      std::chrono::seconds(status.st_mtim.tv_sec) + std::chrono::nanoseconds(status.st_mtim.tv_nsec);
  return std::chrono::duration<double>(now.time_since_epoch() - changed).count();
}

std::string problem_of_age(double age_s, int max_age_s) {
  std::ostringstream why;
  why.precision(3);
  if (age_s > max_age_s) {
    why << "was written " << age_s << " s ago, temperature.max_age_s is " << max_age_s << ": look after what writes it";
  } else if (age_s < -kClockTolerance_s) {
    why << "is " << -age_s << " s newer than now: set the clocks";
  }
  return why.str();
}

}  // namespace

TemperatureReading read_temperature(const TemperatureConfig& source, std::chrono::system_clock::time_point now) {
  const auto failed = [&source](const char* what) {
    return unknown(source, what + std::generic_category().message(errno));
  };
  const UniqueFd file(::open(source.file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() < 0) return failed("cannot be opened: ");
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) return failed("cannot be looked at: ");
  if (!S_ISREG(status.st_mode)) return unknown(source, "is no regular file: name one that holds a number");
  std::array<char, kMaxNumber_bytes + 1> text{};
  const ssize_t size = ::read(file.get(), text.data(), text.size());
  if (size < 0) return failed("cannot be read: ");
  const auto bytes = static_cast<std::size_t>(size);
  const auto number = bytes > kMaxNumber_bytes ? std::nullopt : number_in({text.data(), bytes});
  if (!number) return unknown(source, "does not hold one number and nothing else");
  const double celsius = *number * source.scale + source.offset_c;
  if (!(celsius >= kLowest_c && celsius <= kHighest_c)) {
    std::ostringstream why;
    why << "tells " << celsius << " degC, outside -50..100: check temperature.scale and offset_c";
    return unknown(source, why.str());
  }
  const double age = age_s(file.get(), status, now);
  if (const std::string why = problem_of_age(age, source.max_age_s); !why.empty()) return unknown(source, why);
  return {Temperature{celsius, source.file.string(), std::max(age, 0.0)}, {}};
}

void note_temperature(const JobRequest& request, const TemperatureConfig& source, ResultData& result) {
  if (request.temperature_c) {
    result.temperature = Temperature{*request.temperature_c, "job", 0.0};
    return;
  }
  if (source.file.empty()) return;
  TemperatureReading reading = read_temperature(source, std::chrono::system_clock::now());
  result.temperature = std::move(reading.temperature);
  if (!result.temperature) result.warnings.push_back({"temperature_unknown", std::move(reading.problem)});
}

}  // namespace fvd
