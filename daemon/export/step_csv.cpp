#include "daemon/export/step_csv.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>

namespace fvd {

namespace {

class Row {
 public:
  explicit Row(std::string& out) : out_(out) {}
  ~Row() { out_ += '\n'; }
  Row(const Row&) = delete;
  Row& operator=(const Row&) = delete;

  /// decimals: enough that no digit of meaning is lost, few enough to be read.
  Row& number(double value, int decimals) {
    char text[64];
    const auto end = std::to_chars(std::begin(text), std::end(text), value, std::chars_format::fixed, decimals);
    return cell(end.ec == std::errc() ? std::string_view(text, static_cast<std::size_t>(end.ptr - text)) : "");
  }
  template <typename Integer>
  Row& integer(Integer value) {
    return cell(std::to_string(value));
  }
  Row& empty(int cells) {
    for (int i = 0; i < cells; ++i) cell("");
    return *this;
  }

 private:
  Row& cell(std::string_view text) {
    if (!first_) out_ += ',';
    first_ = false;
    out_ += text;
    return *this;
  }

  std::string& out_;
  bool first_ = true;
};

constexpr int kMeasuredColumns = 6;

}  // namespace

std::string step_csv(const StepLog& log) {
  std::string out =
      "index,measured,commanded_um,quantised_um,commanded_counts,move_ms,settle_polls,triggers,"
      "measured_um,measured_sd_um,position_samples,error_um,frame_id,exposure_start_ms\n";
  const auto first = std::find_if(log.begin(), log.end(), [](const StepRecord& step) { return step.measured; });
  for (const StepRecord& step : log) {
    Row row(out);
    row.integer(step.index).integer(step.measured ? 1 : 0).number(step.commanded_um, 6).number(step.quantised_um, 6);
    row.integer(step.commanded_counts).number(step.move_ms, 3).integer(step.settle_polls).integer(step.triggers);
    if (!step.measured) {
      row.empty(kMeasuredColumns);
      continue;
    }
    row.number(step.measured_um, 6).number(step.measured_sd_um, 6).integer(step.position_samples);
    row.number(step.error_um, 6).integer(step.frame_id);
    row.number(std::chrono::duration<double, std::milli>(step.exposure_start - first->exposure_start).count(), 3);
  }
  return out;
}

}  // namespace fvd
