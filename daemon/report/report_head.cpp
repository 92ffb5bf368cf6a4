#include "daemon/report/report_head.hpp"

#include "daemon/report/time_text.hpp"
#include "daemon/report/verdict_sign.hpp"

namespace fvd {

namespace {

constexpr double kLine = 11.0;
constexpr double kText = 7.5;
constexpr double kLabelRoom = 50.0;
constexpr std::size_t kShownDigits = 12;

/// Returns the left end of what it draws.
double draw_verdict(Canvas& canvas, const PageRect& page, const Result& result) {
  double left = page.right();
  if (result.verdict) {
    const TextStyle style{.size = 15.0, .ink = verdict_ink(*result.verdict), .bold = true, .align = TextAlign::kRight};
    const char* const word = verdict_word(*result.verdict);
    canvas.text({page.right(), page.y + 15.0}, word, style);
    left -= canvas.text_width(word, style) + 13.0;
    draw_verdict_sign(canvas, {left, page.y + 9.7}, 15.0, *result.verdict);
    left -= 20.0;
  }
  if (result.provenance.simulated) {
    const TextStyle style{.size = 10.0, .ink = colour::kBad, .bold = true, .align = TextAlign::kRight};
    canvas.text({left, page.y + 14.5}, "SIMULATED", style);
    left -= canvas.text_width("SIMULATED", style) + 12.0;
  }
  return left;
}

void draw_fact(Canvas& canvas, PagePoint at, double width, const std::string& name, const std::string& value) {
  canvas.text(at, name, {.size = kText - 1.0, .ink = colour::kPaleInk});
  canvas.text({at.x + kLabelRoom, at.y}, value.empty() ? "-" : value, {.size = kText, .room = width - kLabelRoom});
}

std::string recipe_text(const Result& result) {
  if (result.recipe.id.empty()) return "none";
  if (result.recipe.sha256.empty()) return result.recipe.id + ", changed by options";
  return result.recipe.id + "  " + result.recipe.sha256.substr(0, kShownDigits);
}

/// The identifier with the day it was made, and what of it was past its day when the part was measured.
std::string calibration_text(const Result& result) {
  if (!result.calibration) return result.evaluation ? result.evaluation->calibration : "none";
  const Calibration& calibration = *result.calibration;
  constexpr std::size_t kDay = 10;  // of "2026-11-29T20:15:00Z"
  std::string text = calibration.id + ", " + calibration.created.substr(0, kDay);
  const std::string parts = lapsed_text(calibration, calendar_day(result.provenance.created));
  if (!parts.empty()) text += ", lapsed: " + parts;
  return text;
}

std::string job_text(const Result& result) {
  if (result.job.id.empty()) return "none: recorded slices";
  return result.job.id + (result.job.seq ? ", number " + std::to_string(*result.job.seq) : std::string());
}

}  // namespace

std::string report_title(const Result& result) {
  if (!result.job.part_id.empty()) return result.job.part_id;
  return result.job.id.empty() ? "height map" : result.job.id;
}

double draw_head(Canvas& canvas, const PageRect& page, const Result& result) {
  const double room = draw_verdict(canvas, page, result) - page.x - 8.0;
  canvas.text({page.x, page.y + 15.0}, report_title(result), {.size = 15.0, .bold = true, .room = room});
  canvas.text({page.x, page.y + 26.0}, "Measurement report", {.size = 7.5, .ink = colour::kPaleInk});
  const double middle = page.x + page.width / 2.0 + 6.0;
  const double width = page.width / 2.0 - 10.0;
  double y = page.y + 40.0;
  draw_fact(canvas, {page.x, y}, width, "Part", result.job.part_id);
  draw_fact(canvas, {middle, y}, width, "Recipe", recipe_text(result));
  y += kLine;
  draw_fact(canvas, {page.x, y}, width, "Job", job_text(result));
  draw_fact(canvas, {middle, y}, width, "Instrument", result.provenance.source);
  y += kLine;
  draw_fact(canvas, {page.x, y}, width, "Time", people_time_text(result.provenance.created));
  draw_fact(canvas, {middle, y}, width, "Calibration", calibration_text(result));
  y += 6.0;
  canvas.line({page.x, y}, {page.right(), y}, colour::kInk, 0.6);
  return y + 10.0;
}

double draw_short_head(Canvas& canvas, const PageRect& page, const Result& result) {
  const double room = draw_verdict(canvas, page, result) - page.x - 8.0;
  canvas.text({page.x, page.y + 15.0}, report_title(result) + ", continued",
              {.size = 11.0, .bold = true, .room = room});
  canvas.line({page.x, page.y + 24.0}, {page.right(), page.y + 24.0}, colour::kInk, 0.6);
  return page.y + 34.0;
}

void draw_foot(Canvas& canvas, const PageRect& page, const Result& result, const std::string& sha256, int number,
               bool goes_on) {
  const double y = page.bottom();
  canvas.line({page.x, y - 9.0}, {page.right(), y - 9.0}, colour::kRule, 0.4);
  canvas.text({page.x, y}, "fvd " + result.provenance.software_version + "   surface SHA-256 " + sha256,
              {.size = 6.0, .ink = colour::kPaleInk, .room = page.width - 50.0});
  const std::string count = goes_on ? ", continued" : " of " + std::to_string(number);
  canvas.text({page.right(), y}, "page " + std::to_string(number) + count,
              {.size = 6.0, .ink = colour::kPaleInk, .align = TextAlign::kRight});
}

}  // namespace fvd
