#pragma once

/// Words on a drawn page. Only sources of this folder include it: it includes OpenCV.

#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace fvd {

namespace page_colour {  // BGR
inline const cv::Scalar kBackground(255, 255, 255);
inline const cv::Scalar kInk(40, 40, 40);
inline const cv::Scalar kPaleInk(110, 110, 110);
inline const cv::Scalar kWarning(20, 20, 180);
}  // namespace page_colour

/// In pixels. size: 1 = capitals of about 21 pixels.
[[nodiscard]] int text_width(const std::string& text, double size, int thickness = 1);

/// at: left end of the base line.
void put_text(cv::Mat& page, const std::string& text, cv::Point at, double size, const cv::Scalar& colour,
              int thickness = 1);

/// Cuts text that would take more than `room` pixels.
[[nodiscard]] std::string fitted_text(std::string text, double size, int room);

/// Lines of at most `room` pixels, broken at spaces.
[[nodiscard]] std::vector<std::string> wrapped_text(const std::string& text, double size, int room);

/// Title and subtitle at the top of a page, the SIMULATED badge at its right. margin: pixels kept free at both sides.
void draw_page_header(cv::Mat& page, const std::string& title, const std::string& subtitle, bool simulated, int margin);

}  // namespace fvd
