#include "daemon/report/verdict_sign.hpp"

namespace fvd {

namespace {

void draw_pass(Canvas& canvas, PagePoint at, double half) {
  canvas.disc(at, half, colour::kGood);
  const PagePoint tick[] = {{at.x - 0.48 * half, at.y + 0.05 * half},
                            {at.x - 0.12 * half, at.y + 0.42 * half},
                            {at.x + 0.50 * half, at.y - 0.38 * half}};
  canvas.polyline(tick, colour::kPaper, 0.26 * half);
}

void draw_fail(Canvas& canvas, PagePoint at, double half) {
  canvas.fill({at.x - half, at.y - half, 2.0 * half, 2.0 * half}, colour::kBad);
  const double arm = 0.52 * half;
  canvas.line({at.x - arm, at.y - arm}, {at.x + arm, at.y + arm}, colour::kPaper, 0.28 * half);
  canvas.line({at.x - arm, at.y + arm}, {at.x + arm, at.y - arm}, colour::kPaper, 0.28 * half);
}

void draw_uncertain(Canvas& canvas, PagePoint at, double half) {
  const double reach = 1.2 * half;
  const PagePoint diamond[] = {{at.x - reach, at.y}, {at.x, at.y - reach}, {at.x + reach, at.y}, {at.x, at.y + reach}};
  canvas.polygon(diamond, colour::kDoubt);
  canvas.text({at.x, at.y + 0.52 * half}, "?",
              {.size = 1.4 * half, .ink = colour::kPaper, .bold = true, .align = TextAlign::kCentre});
}

void draw_invalid(Canvas& canvas, PagePoint at, double half) {
  const double side = 0.9 * half;
  canvas.frame({at.x - side, at.y - side, 2.0 * side, 2.0 * side}, colour::kInk, 0.22 * half);
  canvas.line({at.x - side, at.y + side}, {at.x + side, at.y - side}, colour::kInk, 0.22 * half);
}

}  // namespace

void draw_verdict_sign(Canvas& canvas, PagePoint centre, double size, Verdict verdict) {
  const double half = size / 2.0;
  switch (verdict) {
    case Verdict::kPass:
      return draw_pass(canvas, centre, half);
    case Verdict::kFail:
      return draw_fail(canvas, centre, half);
    case Verdict::kUncertain:
      return draw_uncertain(canvas, centre, half);
    case Verdict::kInvalid:
      return draw_invalid(canvas, centre, half);
  }
}

Colour verdict_ink(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPass:
      return colour::kGood;
    case Verdict::kFail:
      return colour::kBad;
    case Verdict::kUncertain:
      return colour::kDoubt;
    case Verdict::kInvalid:
      break;
  }
  return colour::kInk;
}

const char* verdict_word(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPass:
      return "PASS";
    case Verdict::kFail:
      return "FAIL";
    case Verdict::kUncertain:
      return "UNCERTAIN";
    case Verdict::kInvalid:
      break;
  }
  return "INVALID";
}

}  // namespace fvd
