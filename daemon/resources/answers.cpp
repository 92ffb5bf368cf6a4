#include "daemon/resources/answers.hpp"

#include <array>
#include <charconv>

namespace fvd {

ResourceAnswer refused(const HttpRefusal& refusal) {
  ResourceAnswer answer;
  answer.status = refusal.status;
  answer.fields = {{"Content-Type", "application/json"}, {"Cache-Control", "no-store"}};
  answer.body = refusal.body();
  return answer;
}

ResourceAnswer not_modified(const std::string& etag, const std::string& cache_control) {
  ResourceAnswer answer;
  answer.status = 304;
  answer.fields = {{"ETag", etag}, {"Cache-Control", cache_control}};
  return answer;
}

std::string number_text(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end.ptr};
}

}  // namespace fvd
