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

/// Thrown out of the parser's callback; never leaves this file.
struct Refused {
  std::string message;
};

/// nlohmann counts the bytes read, the offending one included.
std::string position(std::string_view text, std::size_t bytes_read) {
  const auto before = text.substr(0, std::min(bytes_read > 0 ? bytes_read - 1 : 0, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const auto last_break = before.rfind('\n');
  const auto column = last_break == std::string_view::npos ? before.size() + 1 : before.size() - last_break;
  return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

/// Follows the parser and refuses what it would let pass.
class Watch {
 public:
  bool operator()(int /*depth*/, json::parse_event_t event, const json& parsed) {
    using Event = json::parse_event_t;
    if (event == Event::object_start || event == Event::array_start) {
      keys_.emplace_back();
      if (keys_.size() > kMaxJsonDepth) {
        throw Refused{"nested deeper than " + std::to_string(kMaxJsonDepth) + " levels"};
      }
    } else if (event == Event::object_end || event == Event::array_end) {
      keys_.pop_back();
    } else if (event == Event::key && !keys_.back().insert(parsed.get<std::string>()).second) {
      throw Refused{"the key '" + parsed.get<std::string>() + "' stands twice in one object"};
    }
    return true;
  }

 private:
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
  Watch watch;
  try {
    return json::parse(text.begin(), text.end(), std::ref(watch), true, comments == JsonComments::kAllowed);
  } catch (const json::parse_error& error) {
    problems.push_back({"", "no valid JSON at " + position(text, error.byte) + ": " + reason_of(error)});
  } catch (const json::exception& error) {
    problems.push_back({"", std::string("no valid JSON: ") + error.what()});
  } catch (const Refused& refused) {
    problems.push_back({"", refused.message});
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
