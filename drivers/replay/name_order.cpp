#include "drivers/replay/name_order.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "core/base/error.hpp"
#include "drivers/replay/name_columns.hpp"
#include "drivers/replay/time_stamp.hpp"

namespace fvd {

namespace {

using Order = std::vector<std::size_t>;

/// Numbers of more digits are time stamps or hashes, not counts.
constexpr std::size_t kMaxCountDigits = 9;
constexpr std::size_t kLeastRolloverDigits = 4;  ///< DSC_9999, DSC_0001; of s_99, s_01 it is not known
constexpr double kLeastJump = 0.9;               ///< as a share of all numbers of a counter

std::string in_folder(const NameColumns& columns, const std::string& pattern, const std::string& more = {}) {
  return pattern + " (" + std::to_string(columns.rows()) + " files" + more + ")";
}

std::vector<std::string> names_in(const NameColumns& columns, const Order& order) {
  std::vector<std::string> names;
  for (const std::size_t row : order) names.push_back(columns.name(row));
  return names;
}

[[noreturn]] void refuse_twice(const NameColumns& columns, std::size_t a, std::size_t b) {
  throw Error(ErrorCode::kBadInput, columns.name(a) + " and " + columns.name(b) +
                                        " have the same number: their order is not known; move one of them away, or " +
                                        "say with --pattern of fvdctl which names are slices");
}

void require_distinct(const NameColumns& columns, std::size_t column, const Order& order) {
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (compare(columns.at(order[i - 1], column), columns.at(order[i], column)) == 0) {
      refuse_twice(columns, order[i - 1], order[i]);
    }
  }
}

std::vector<double> values_of(const NameColumns& columns, std::size_t column, const Order& order) {
  std::vector<double> values;
  for (const std::size_t row : order) values.push_back(columns.at(row, column).value());
  return values;
}

/// Rounding of the numbers by their decimal places; whole numbers are counts, which are exact.
double rounding(const NameColumns& columns, std::size_t column) {
  std::size_t places = 0;
  for (std::size_t row = 0; row < columns.rows(); ++row) {
    places = std::max(places, columns.at(row, column).fraction.size());
  }
  return places == 0 ? 0.0 : 1.01 * std::pow(10.0, -static_cast<double>(places));
}

std::string gap_of(const NameColumns& columns, std::size_t column, const Order& order) {
  for (const std::size_t row : order) {
    if (order.size() < 3 || columns.at(row, column).digits.size() <= kMaxCountDigits) continue;
    if (columns.at(row, column).digits.find_first_not_of('0') + kMaxCountDigits >=
        columns.at(row, column).digits.size())
      continue;
    return "the numbers in the names, such as " + columns.name(row) + ", are too long to be counts";
  }
  return uneven_spacing(values_of(columns, column, order), names_in(columns, order), rounding(columns, column));
}

/// Whether a counter of fixed width began again within the stack, by a jump over nearly all its numbers: turns `order`
/// so that the first slice comes first. values: in that order, made to rise across the turn.
bool roll_over(const NameColumns& columns, std::size_t column, Order& order, std::vector<double>& values) {
  const std::size_t width = columns.at(order.front(), column).digits.size();
  if (width < kLeastRolloverDigits || width > kMaxCountDigits || order.size() < 2) return false;
  for (const std::size_t row : order) {
    const NameNumber& number = columns.at(row, column);
    if (number.digits.size() != width || number.sign != '\0' || !number.fraction.empty()) return false;
  }
  const double full = std::pow(10.0, static_cast<double>(width));
  std::size_t turn = 1;
  for (std::size_t i = 2; i < values.size(); ++i) {
    if (values[i] - values[i - 1] > values[turn] - values[turn - 1]) turn = i;
  }
  if (values[turn] - values[turn - 1] < kLeastJump * full) return false;
  const double period = values.front() == 0.0 ? full : full - 1.0;  // 9999 is followed by 0000 or by 0001
  for (std::size_t i = 0; i < turn; ++i) values[i] += period;
  const auto by = static_cast<std::ptrdiff_t>(turn);
  std::rotate(values.begin(), values.begin() + by, values.end());
  std::rotate(order.begin(), order.begin() + by, order.end());
  return true;
}

NameOrder by_one_number(const NameColumns& columns, std::size_t column) {
  NameOrder result;
  result.order = columns.sorted(column);
  require_distinct(columns, column, result.order);
  std::vector<double> values = values_of(columns, column, result.order);
  const std::string pattern = columns.pattern({column}, "*");
  if (roll_over(columns, column, result.order, values)) {
    result.gap = uneven_spacing(values, names_in(columns, result.order), 0.0);
    result.description = in_folder(columns, pattern, ", the counter rolls over");
  } else {
    result.gap = gap_of(columns, column, result.order);
    result.description = in_folder(columns, pattern);
  }
  return result;
}

/// How numbers go along an order: 1 all rise, -1 all fall, else 0.
int direction(const std::vector<double>& values) {
  const auto not_above = [](double a, double b) { return !(b > a); };
  const auto not_below = [](double a, double b) { return !(b < a); };
  if (std::adjacent_find(values.begin(), values.end(), not_above) == values.end()) return 1;
  return std::adjacent_find(values.begin(), values.end(), not_below) == values.end() ? -1 : 0;
}

/// In the order in which the slices were counted if another number says so, else upwards.
NameOrder by_z(const NameColumns& columns, std::size_t z_column, const Order& varying) {
  NameOrder result;
  if (!columns.distinct(z_column) && varying.size() > 1) {
    columns.ask("several names have the same z, such as that of " + columns.name(0), {z_column});
  }
  result.order = columns.sorted(z_column);
  require_distinct(columns, z_column, result.order);
  for (const std::size_t column : varying) {
    if (column == z_column || direction(values_of(columns, column, result.order)) != -1) continue;
    std::reverse(result.order.begin(), result.order.end());
    break;
  }
  result.gap = gap_of(columns, z_column, result.order);
  result.description = in_folder(columns, columns.pattern(varying, "*"));
  result.z_um = values_of(columns, z_column, result.order);
  for (double& z : result.z_um) z *= *columns.unit_um(z_column);
  return result;
}

NameOrder by_numbers_together(const NameColumns& columns, const Order& varying) {
  const Order order = columns.sorted(varying.front());
  for (const std::size_t column : varying) {
    if (direction(values_of(columns, column, order)) == 1) continue;
    columns.ask("more than one number varies in the names, such as " + columns.name(0), varying);
  }
  NameOrder result;
  result.order = order;
  for (const std::size_t column : varying) {
    result.gap = gap_of(columns, column, order);
    if (result.gap.empty()) break;
  }
  result.description = in_folder(columns, columns.pattern(varying, "*"));
  return result;
}

/// The names with '*' in the place of their time stamps, and these.
struct TimedNames {
  std::vector<std::string> rest;
  std::vector<double> seconds;
};

std::optional<TimedNames> time_stamps_in(const std::vector<std::string>& names) {
  TimedNames result;
  for (const std::string& name : names) {
    const auto stamp = find_time_stamp(name);
    if (!stamp) return std::nullopt;
    result.seconds.push_back(stamp->seconds);
    result.rest.push_back(std::string(name).replace(stamp->position, stamp->length, "*"));
  }
  const auto same = [&](double seconds) { return seconds == result.seconds.front(); };
  if (std::all_of(result.seconds.begin(), result.seconds.end(), same)) return std::nullopt;
  return result;
}

/// A pause in which one slice more would have had room.
std::string pause_in(const std::vector<double>& seconds, const std::vector<std::string>& names) {
  constexpr double kLongPause = 1.6;
  if (seconds.size() < 4) return {};
  std::vector<double> pauses;
  for (std::size_t i = 1; i < seconds.size(); ++i) pauses.push_back(seconds[i] - seconds[i - 1]);
  std::vector<double> ordered = pauses;
  const auto middle = ordered.begin() + static_cast<std::ptrdiff_t>(ordered.size() / 2);
  std::nth_element(ordered.begin(), middle, ordered.end());
  const bool whole = std::all_of(seconds.begin(), seconds.end(), [](double s) { return s == std::floor(s); });
  const double limit = kLongPause * *middle + (whole ? 1.0 : 0.0);
  for (std::size_t i = 0; i < pauses.size(); ++i) {
    if (pauses[i] <= limit) continue;
    std::ostringstream text;
    text << "between " << names[i] << " and " << names[i + 1] << " passed " << pauses[i] << " s, usually " << *middle
         << " s: a slice may be missing, which shifts all heights beyond it";
    return text.str();
  }
  return {};
}

/// Sorts by seconds, then by the number after them if there is one.
NameOrder by_time(const TimedNames& timed, const NameColumns& rest, const std::vector<std::string>& names) {
  const Order varying = rest.varying();
  if (varying.size() > 1) rest.ask("more than one number varies in the names beside the time", varying);
  NameOrder result;
  result.order.resize(names.size());
  std::iota(result.order.begin(), result.order.end(), std::size_t{0});
  if (!varying.empty()) result.order = rest.sorted(varying.front());
  std::stable_sort(result.order.begin(), result.order.end(),
                   [&](std::size_t a, std::size_t b) { return timed.seconds[a] < timed.seconds[b]; });
  std::vector<double> seconds;
  std::vector<std::string> ordered;
  for (const std::size_t row : result.order) {
    seconds.push_back(timed.seconds[row]);
    ordered.push_back(names[row]);
  }
  for (std::size_t i = 1; i < seconds.size(); ++i) {
    if (seconds[i] > seconds[i - 1]) continue;
    const bool counted = !varying.empty() && compare(rest.at(result.order[i - 1], varying.front()),
                                                     rest.at(result.order[i], varying.front())) < 0;
    if (!counted) refuse_twice(NameColumns(names), result.order[i - 1], result.order[i]);
  }
  result.description = in_folder(rest, rest.pattern(varying, "*"), ", by time");
  result.doubt = pause_in(seconds, ordered);
  return result;
}

/// Names that carry z or a count beside the time are ordered by that, and the clock must not contradict.
std::optional<NameOrder> by_count_beside_time(const TimedNames& timed, const NameColumns& rest) {
  const Order varying = rest.varying();
  if (varying.size() != 1 || !rest.distinct(varying.front())) return std::nullopt;
  const auto unit = rest.unit_um(varying.front());
  NameOrder result = unit ? by_z(rest, varying.front(), varying) : by_one_number(rest, varying.front());
  std::vector<double> seconds;
  for (const std::size_t row : result.order) seconds.push_back(timed.seconds[row]);
  if (unit && std::is_sorted(seconds.rbegin(), seconds.rend())) {
    std::reverse(result.order.begin(), result.order.end());
    std::reverse(result.z_um.begin(), result.z_um.end());
  } else if (!unit && !std::is_sorted(seconds.begin(), seconds.end())) {
    return std::nullopt;  // thousandths of a second rather than a count
  }
  return result;
}

}  // namespace

std::string uneven_spacing(const std::vector<double>& values, const std::vector<std::string>& names, double tolerance) {
  if (values.size() < 3) return {};
  const auto step = [&](std::size_t i) { return std::abs(values[i] - values[i - 1]); };
  double smallest = step(1);
  for (std::size_t i = 2; i < values.size(); ++i) smallest = std::min(smallest, step(i));
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (step(i) > smallest + tolerance + 1e-9 * smallest) return names[i - 1] + " is followed by " + names[i];
  }
  return {};
}

NameOrder order_names(const std::vector<std::string>& names) {
  if (const auto timed = time_stamps_in(names)) {
    const std::set<std::string> skeletons = [&] {
      std::set<std::string> found;
      for (const auto& name : timed->rest) {
        found.insert(name_fields(std::filesystem::path(name).stem().string()).skeleton());
      }
      return found;
    }();
    if (skeletons.size() == 1) {
      const NameColumns rest(timed->rest);
      if (auto order = by_count_beside_time(*timed, rest)) return *order;
      const NameColumns columns(names);
      const Order varying = columns.varying();
      // one number that goes evenly, or one of less than ten minutes past midnight, is a count that looks like a time
      const bool counts = varying.size() == 1 && columns.distinct(varying.front()) &&
                          (by_one_number(columns, varying.front()).gap.empty() ||
                           columns.at(columns.sorted(varying.front()).back(), varying.front()).value() < 1000.0);
      if (!counts) return by_time(*timed, rest, names);
    }
  }
  const NameColumns columns(names);
  const Order varying = columns.varying();
  if (varying.empty()) refuse_twice(columns, 0, 1);
  Order with_unit;
  for (const std::size_t column : varying) {
    if (columns.unit_um(column)) with_unit.push_back(column);
  }
  if (with_unit.size() > 1) columns.ask("more than one length varies in the names, such as " + names[0], with_unit);
  if (with_unit.size() == 1) return by_z(columns, with_unit.front(), varying);
  return varying.size() == 1 ? by_one_number(columns, varying.front()) : by_numbers_together(columns, varying);
}

}  // namespace fvd
