#include "daemon/api/utc_bound.hpp"

#include <algorithm>
#include <chrono>

#include "daemon/api/replies.hpp"
#include "daemon/api/rpc_errors.hpp"

namespace fvd {

namespace {

constexpr std::string_view kForm = "0000-00-00T00:00:00.000Z";  // 0 stands for a digit
constexpr std::size_t kUpToSeconds_bytes = 19;

bool has_form(std::string_view text) {
  return text.size() == kForm.size() && std::equal(text.begin(), text.end(), kForm.begin(), [](char c, char form) {
           return form == '0' ? c >= '0' && c <= '9' : c == form;
         });
}

unsigned number_at(std::string_view text, std::size_t at, std::size_t digits) {
  unsigned number = 0;
  for (const char digit : text.substr(at, digits)) number = 10 * number + static_cast<unsigned>(digit - '0');
  return number;
}

bool is_moment(std::string_view text) {
  const std::chrono::year_month_day day{std::chrono::year(static_cast<int>(number_at(text, 0, 4))),
                                        std::chrono::month(number_at(text, 5, 2)),
                                        std::chrono::day(number_at(text, 8, 2))};
  constexpr unsigned kLeapSecond = 60;
  return day.ok() && number_at(text, 11, 2) < 24 && number_at(text, 14, 2) < 60 &&
         number_at(text, 17, 2) <= kLeapSecond;
}

std::string moment(std::string_view name, const std::string& text, std::string_view milliseconds) {
  if (text.empty()) return {};
  std::string whole = text;
  if (text.size() == kUpToSeconds_bytes + 1) whole.insert(kUpToSeconds_bytes, milliseconds);
  if (has_form(whole) && is_moment(whole)) return whole;
  throw ProtocolError{json_rpc::kInvalidParams, std::string(name) + ": " + quoted(text) +
                                                    " is no time; expected UTC as 2026-11-30T10:00:00Z, or with "
                                                    "milliseconds as 2026-11-30T10:00:00.000Z"};
}

}  // namespace

std::string first_moment(std::string_view name, const std::string& text) { return moment(name, text, ".000"); }

std::string last_moment(std::string_view name, const std::string& text) { return moment(name, text, ".999"); }

}  // namespace fvd
