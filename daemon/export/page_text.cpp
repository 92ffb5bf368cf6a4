#include "daemon/export/page_text.hpp"

#include <sstream>

#include <opencv2/imgproc.hpp>

namespace fvd {

namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;

}  // namespace

int text_width(const std::string& text, double size, int thickness) {
  int baseline = 0;
  return cv::getTextSize(text, kFont, size, thickness, &baseline).width;
}

void put_text(cv::Mat& page, const std::string& text, cv::Point at, double size, const cv::Scalar& colour,
              int thickness) {
  cv::putText(page, text, at, kFont, size, colour, thickness, cv::LINE_AA);
}

std::string fitted_text(std::string text, double size, int room) {
  if (text_width(text, size) <= room) return text;
  while (!text.empty() && text_width(text + "...", size) > room) text.pop_back();
  return text + "...";
}

std::vector<std::string> wrapped_text(const std::string& text, double size, int room) {
  std::vector<std::string> lines;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!lines.empty() && text_width(lines.back() + " " + word, size) <= room) {
      lines.back() += " " + word;
    } else {
      lines.push_back(word);
    }
  }
  return lines;
}

void draw_page_header(cv::Mat& page, const std::string& title, const std::string& subtitle, bool simulated,
                      int margin) {
  int right = page.cols - margin;
  if (simulated) {
    const std::string badge = "SIMULATED";
    right -= text_width(badge, 0.6, 2);
    put_text(page, badge, {right, 38}, 0.6, page_colour::kWarning, 2);
    right -= margin;
  }
  put_text(page, fitted_text(title, 0.75, right - margin), {margin, 38}, 0.75, page_colour::kInk);
  put_text(page, fitted_text(subtitle, 0.45, page.cols - 2 * margin), {margin, 64}, 0.45, page_colour::kPaleInk);
}

}  // namespace fvd
