#include "daemon/report/value_table.hpp"

#include <string>

#include "daemon/report/verdict_sign.hpp"

namespace fvd {

namespace {

constexpr double kRow = 11.5;
constexpr double kText = 7.5;
constexpr double kHeadText = 6.5;

/// Where columns are, as shares of the width. Numbers end at their place.
constexpr double kNameAt = 0.19;
constexpr double kValueAt = 0.46;
constexpr double kUncertaintyAt = 0.60;
constexpr double kUnitAt = 0.615;
constexpr double kLimitsAt = 0.68;
constexpr double kVerdictAt = 0.855;

void draw_row(Canvas& canvas, PagePoint at, double width, const ValueRow& row) {
  const double base = at.y + kRow - 3.3;
  const auto x = [&](double share) { return at.x + share * width; };
  canvas.text({at.x, base}, row.measurement, {.size = kText, .bold = true, .room = kNameAt * width - 4.0});
  canvas.text({x(kNameAt), base}, row.name, {.size = kText, .room = (kValueAt - kNameAt) * width - 44.0});
  if (row.reason.empty()) {
    canvas.text({x(kValueAt), base}, row.value, {.size = kText, .bold = true, .align = TextAlign::kRight});
    canvas.text({x(kUncertaintyAt), base}, row.uncertainty, {.size = kText, .align = TextAlign::kRight});
    canvas.text({x(kUnitAt), base}, row.unit, {.size = kText});
  } else {
    const double left = x(kValueAt) - 36.0;
    canvas.text({left, base}, "-  " + row.reason,
                {.size = kText - 1.0, .ink = colour::kPaleInk, .room = x(kLimitsAt) - left - 4.0});
  }
  canvas.text({x(kLimitsAt), base}, row.limits, {.size = kText, .room = (kVerdictAt - kLimitsAt) * width - 4.0});
  if (!row.verdict) return;
  draw_verdict_sign(canvas, {x(kVerdictAt) + 4.0, at.y + kRow / 2.0}, 7.0, *row.verdict);
  canvas.text({x(kVerdictAt) + 12.0, base}, verdict_word(*row.verdict),
              {.size = kText, .ink = verdict_ink(*row.verdict), .bold = true});
}

void draw_head(Canvas& canvas, PagePoint at, double width) {
  const TextStyle left{.size = kHeadText, .ink = colour::kPaleInk};
  const TextStyle right{.size = kHeadText, .ink = colour::kPaleInk, .align = TextAlign::kRight};
  const double base = at.y + kRow - 3.5;
  canvas.text({at.x, base}, "Measurement", left);
  canvas.text({at.x + kNameAt * width, base}, "Quantity", left);
  canvas.text({at.x + kValueAt * width, base}, "Value", right);
  canvas.text({at.x + kUncertaintyAt * width, base}, "U (k)", right);
  canvas.text({at.x + kUnitAt * width, base}, "Unit", left);
  canvas.text({at.x + kLimitsAt * width, base}, "Limits", left);
  canvas.text({at.x + kVerdictAt * width, base}, "Verdict", left);
  canvas.line({at.x, at.y + kRow}, {at.x + width, at.y + kRow}, colour::kInk, 0.6);
}

}  // namespace

double table_height(std::size_t rows) { return kRow * (static_cast<double>(rows) + 1.0) + 2.0; }

void draw_table(Canvas& canvas, PagePoint top_left, double width, std::span<const ValueRow> rows) {
  draw_head(canvas, top_left, width);
  PagePoint at = top_left;
  for (const ValueRow& row : rows) {
    at.y += kRow;
    draw_row(canvas, at, width, row);
    canvas.line({at.x, at.y + kRow}, {at.x + width, at.y + kRow}, colour::kGrid, 0.4);
  }
}

}  // namespace fvd
