#include "daemon/resources/live_resource.hpp"

#include <charconv>
#include <chrono>
#include <cmath>
#include <optional>
#include <string>

#include "daemon/resources/answers.hpp"

namespace fvd {

namespace {

constexpr std::chrono::seconds kPatience{5};
constexpr std::chrono::milliseconds kLookAgain{40};

/// The number of the picture that the caller has; nothing where the query is wrong.
std::optional<std::uint64_t> known_picture(const std::map<std::string, std::string>& query) {
  std::uint64_t after = 0;
  for (const auto& [key, text] : query) {
    const auto read = std::from_chars(text.data(), text.data() + text.size(), after);
    if (key != "after" || read.ec != std::errc() || read.ptr != text.data() + text.size()) return std::nullopt;
  }
  return after;
}

}  // namespace

ResourceAnswer LiveResource::get(const ResourceRequest& request) {
  if (request.path != kLivePath) return refused({404, "not_found", "there is GET /api/v1/preview.jpg"});
  const auto after = known_picture(request.query);
  if (!after) return refused({400, "bad_query", "the query may have after, the number of the picture that is known"});
  ResourceAnswer answer;
  answer.fields = {{"Cache-Control", "no-store"}};
  if (const auto picture = live_.other_than(*after)) {
    answer.fields.emplace_back("Content-Type", "image/jpeg");
    answer.fields.emplace_back("X-Fvd-Seq", std::to_string(picture->seq));
    answer.fields.emplace_back("X-Fvd-Width-Px", std::to_string(picture->image_width_px));
    answer.fields.emplace_back("X-Fvd-Height-Px", std::to_string(picture->image_height_px));
    if (std::isfinite(picture->z_um)) answer.fields.emplace_back("X-Fvd-Z-Um", number_text(picture->z_um));
    answer.fields.emplace_back("X-Fvd-Focus", number_text(picture->focus));
    answer.fields.emplace_back("X-Fvd-Saturated-Fraction", number_text(picture->saturated_fraction));
    answer.body = picture->jpeg;
    return answer;
  }
  if (request.waited >= kPatience) {
    answer.status = 204;
  } else {
    answer.again_after = kLookAgain;
  }
  return answer;
}

}  // namespace fvd
