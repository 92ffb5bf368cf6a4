#include "config/strict_json.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <set>
#include <vector>

namespace fvd {

namespace {

using nlohmann::json;

/// nlohmann counts the bytes read, the offending one included.
std::string position(std::string_view text, std::size_t bytes_read) {
  const auto before = text.substr(0, std::min(bytes_read > 0 ? bytes_read - 1 : 0, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const auto last_break = before.rfind('\n');
  const auto column = last_break == std::string_view::npos ? before.size() + 1 : before.size() - last_break;
  return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

/// Follows the parser and stops at what json::parse() would let pass. Not its callback: with one, json::parse() looks
/// at every earlier member of an array after each object in it, minutes for a message of 1 MiB.
class Watch : public nlohmann::json_sax<json> {
 public:
  /// Why it stopped; empty where it did not, or where the text is no JSON.
  [[nodiscard]] const std::string& refusal() const { return refusal_; }

  bool null() override { return true; }
  bool boolean(bool /*value*/) override { return true; }
  bool number_integer(number_integer_t /*value*/) override { return true; }
  bool number_unsigned(number_unsigned_t /*value*/) override { return true; }
  bool number_float(number_float_t /*value*/, const string_t& /*text*/) override { return true; }
  bool string(string_t& /*value*/) override { return true; }
  bool binary(binary_t& /*value*/) override { return true; }
  bool start_object(std::size_t /*elements*/) override { return start(); }
  bool end_object() override { return end(); }
  bool start_array(std::size_t /*elements*/) override { return start(); }
  bool end_array() override { return end(); }
  bool parse_error(std::size_t /*position*/, const std::string& /*last_token*/,
                   const nlohmann::detail::exception& /*error*/) override {
    return false;
  }

  bool key(string_t& key) override {
    if (keys_.back().insert(key).second) return true;
    refusal_ = "the key '" + key + "' stands twice in one object";
    return false;
  }

 private:
  bool start() {
    keys_.emplace_back();
    if (keys_.size() <= kMaxJsonDepth) return true;
    refusal_ = "nested deeper than " + std::to_string(kMaxJsonDepth) + " levels";
    return false;
  }

  bool end() {
    keys_.pop_back();
    return true;
  }

  std::string refusal_;
  std::vector<std::set<std::string>> keys_;
};

/// nlohmann's text without its error number and byte count, which the line and column replace.
std::string reason_of(const json::parse_error& error) {
  std::string text = error.what();
  const auto colon = text.find(": ");
  return colon == std::string::npos ? text : text.substr(colon + 2);
}

}  // namespace

std::optional<json> parse_strict_json(std::string_view text, Problems& problems, JsonComments comments) {
  const bool comments_allowed = comments == JsonComments::kAllowed;
  Watch watch;
  json::sax_parse(text.begin(), text.end(), &watch, json::input_format_t::json, true, comments_allowed);
  if (!watch.refusal().empty()) {
    problems.push_back({"", watch.refusal()});
    return std::nullopt;
  }
  try {
    return json::parse(text.begin(), text.end(), nullptr, true, comments_allowed);
  } catch (const json::parse_error& error) {
    problems.push_back({"", "no valid JSON at " + position(text, error.byte) + ": " + reason_of(error)});
  } catch (const json::exception& error) {
    problems.push_back({"", std::string("no valid JSON: ") + error.what()});
  }
  return std::nullopt;
}

std::string read_text_file(const std::filesystem::path& file, std::uintmax_t most_bytes) {
  const auto fail = [&file](const std::string& reason) {
    return Error(ErrorCode::kBadInput, "cannot read " + file.string() + ": " + reason);
  };
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) throw fail("it is a folder");
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in) throw fail(std::strerror(errno));
  // Not "<< in.rdbuf()": that takes a disk that fails for the end of the file.
  std::string text;
  std::vector<char> piece(std::size_t{1} << 16U);
  errno = 0;
  while (in) {
    in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    text.append(piece.data(), static_cast<std::size_t>(in.gcount()));
    // Not by its size alone: a device has none, and a file may grow meanwhile.
    if (text.size() > most_bytes) throw fail("it is larger than " + std::to_string(most_bytes >> 20U) + " MiB");
  }
  if (in.bad()) throw fail(std::string("the disk does not give it: ") + std::strerror(errno));
  return text;
}

}  // namespace fvd
