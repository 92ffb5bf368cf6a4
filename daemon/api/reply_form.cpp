#include "daemon/api/reply_form.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "daemon/api/replies.hpp"

namespace fvd {

namespace {

using nlohmann::ordered_json;

constexpr std::string_view kCut = "...";

/// Of the character that begins there; 1 where none does.
std::size_t character_bytes(const std::string& text, std::size_t at) {
  const auto first = static_cast<unsigned char>(text[at]);
  const std::size_t wanted = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : first >= 0xC0 ? 2 : 1;
  return std::min(wanted, text.size() - at);
}

/// Takes one thing out of the object: the last element of a list under the key, or the key.
void leave_out(ordered_json& object, const std::string& key) {
  ordered_json& value = object[key];
  if (value.is_array() && !value.empty()) {
    value.erase(value.size() - 1);
  } else {
    object.erase(key);
  }
}

}  // namespace

std::size_t longest_reply_bytes(ReplyFormat format) noexcept {
  switch (format) {
    case ReplyFormat::kCompact:
      return kCompactReply_bytes;
    case ReplyFormat::kFull:
      return kFullReply_bytes;
    case ReplyFormat::kComplete:
      break;
  }
  return std::numeric_limits<std::size_t>::max();
}

ReplyFormat reply_format(std::string_view name) {
  if (name == "compact") return ReplyFormat::kCompact;
  return name == "full" ? ReplyFormat::kFull : ReplyFormat::kComplete;
}

void describe_fields_param(Fields& described, std::vector<std::string>& fields, const std::vector<std::string>& keys) {
  described.choices("fields", fields, keys,
                    "only these keys of the result, in this order, as far as it has them; empty = all of the format");
}

void ReplyFormParams::describe(Fields& described, const std::vector<std::string>& keys) {
  described.choice("format", format, {"full", "compact"},
                   "compact: the keys that a PLC polls, at most 440 bytes; full: at most 1400 bytes");
  describe_fields_param(described, fields, keys);
}

ReplyForm ReplyFormParams::form() const { return {reply_format(format), fields}; }

double rounded_figure(double value) {
  constexpr double kDecimals = 1e4;
  constexpr double kWhole = 1e12;  // has no such decimals, and greater ones would overflow
  return std::abs(value) < kWhole ? std::round(value * kDecimals) / kDecimals : value;
}

std::size_t written_bytes(const ordered_json& value) { return reply_line(value).size(); }

ordered_json picked(const ordered_json& object, const std::vector<std::string>& keys) {
  ordered_json some = ordered_json::object();
  for (const std::string& key : keys) {
    if (object.contains(key)) some[key] = object[key];
  }
  return some;
}

void fit(ordered_json& object, std::size_t bytes, std::span<const std::string_view> give_way) {
  const auto fits = [&] { return written_bytes(object) <= bytes; };
  int left_out = object.value(std::string(kLeftOutKey), 0);
  const auto shorten = [&](const std::string& key) {
    object.erase(kLeftOutKey);
    leave_out(object, key);
    object[kLeftOutKey] = ++left_out;
  };
  for (const std::string_view name : give_way) {
    const std::string key(name);
    while (!fits() && object.contains(key)) shorten(key);
  }
  while (!fits() && object.size() > (left_out == 0 ? 0U : 1U)) {
    auto last = object.end();
    std::advance(last, left_out == 0 ? -1 : -2);  // before kLeftOutKey
    object.erase(last.key());
    object.erase(kLeftOutKey);
    object[kLeftOutKey] = ++left_out;
  }
}

ordered_json formed(ordered_json all, const ReplyForm& form, std::span<const std::string_view> compact,
                    std::size_t envelope_bytes) {
  if (!form.fields.empty()) {
    all = picked(all, form.fields);
  } else if (form.format == ReplyFormat::kCompact) {
    all = picked(all, {compact.begin(), compact.end()});
  }
  const std::size_t most = longest_reply_bytes(form.format);
  if (form.format != ReplyFormat::kComplete) fit(all, most - std::min(most, envelope_bytes));
  return all;
}

void fit_error(ordered_json& reply, std::size_t bytes) {
  auto& message = reply["error"]["message"].get_ref<std::string&>();
  // Once, but for text that is no UTF-8, whose written length depends on what stands beside it.
  for (std::size_t all = written_bytes(reply) + 1; all > bytes && !message.empty(); all = written_bytes(reply) + 1) {
    const std::size_t room = written_bytes(message) - 2;
    message = cut_text(message, room - std::min(room, all - bytes));
  }
}

std::string cut_text(const std::string& text, std::size_t most) {
  const auto size_of = [](const std::string& part) { return written_bytes(part) - 2; };
  if (size_of(text) <= most) return text;
  if (most < kCut.size()) return {};
  std::size_t end = 0;
  for (std::size_t written = kCut.size(); end < text.size();) {
    const std::size_t next = character_bytes(text, end);
    written += size_of(text.substr(end, next));
    if (written > most) break;
    end += next;
  }
  return text.substr(0, end) + std::string(kCut);
}

}  // namespace fvd
