#pragma once

/// How long a reply may be and which keys it has, as the client asked.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "config/fields.hpp"
#include "daemon/api/params.hpp"

namespace fvd {

/// Of a reply as a whole, its end of line included.
inline constexpr std::size_t kCompactReply_bytes = 440;
inline constexpr std::size_t kFullReply_bytes = 1400;

/// The key that counts what a reply lacks because it did not fit; absent where nothing was left out.
inline constexpr const char* kLeftOutKey = "left_out";

enum class ReplyFormat { kCompact, kFull, kComplete };
/// No end for kComplete.
[[nodiscard]] std::size_t longest_reply_bytes(ReplyFormat format) noexcept;

struct ReplyForm {
  ReplyFormat format = ReplyFormat::kFull;
  std::vector<std::string> fields{};  ///< these keys, in this order; empty = the format's own
};

/// The parameters "format" and "fields" of a method, whose result has these keys (names_in()).
struct ReplyFormParams {
  std::string format = "full";
  std::vector<std::string> fields{};

  void describe(Fields& described, const std::vector<std::string>& keys);
  [[nodiscard]] ReplyForm form() const;
};
/// Adds "fields" alone. keys: those that are accepted.
void describe_fields_param(Fields& described, std::vector<std::string>& fields, const std::vector<std::string>& keys);
[[nodiscard]] ReplyFormat reply_format(std::string_view name);

/// The keys that the form asks for. all: every key; compact: keys of the compact form. Within its length: what does not
/// fit is left out from the end, and kLeftOutKey says how many. envelope_bytes: of the reply around it.
[[nodiscard]] nlohmann::ordered_json formed(nlohmann::ordered_json all, const ReplyForm& form,
                                            std::span<const std::string_view> compact, std::size_t envelope_bytes);

/// These keys of an object, as far as it has them.
[[nodiscard]] nlohmann::ordered_json picked(const nlohmann::ordered_json& object, const std::vector<std::string>& keys);

/// Leaves keys out until the object has at most so many bytes: first those of `give_way` in their order, lists by their
/// last elements, then any from the end.
void fit(nlohmann::ordered_json& object, std::size_t bytes, std::span<const std::string_view> give_way = {});

/// Shortens the message of an error reply until the reply fits, its end of line included.
void fit_error(nlohmann::ordered_json& reply, std::size_t bytes = kCompactReply_bytes);

/// The text, its end replaced by "..." where it would be longer than that as it is written in a reply. Whole
/// characters.
[[nodiscard]] std::string cut_text(const std::string& text, std::size_t written_bytes);

/// With four decimals: more than any length, share or angle is sure of.
[[nodiscard]] double rounded_figure(double value);

/// Of a value as it is written in a reply.
[[nodiscard]] std::size_t written_bytes(const nlohmann::ordered_json& value);

}  // namespace fvd
