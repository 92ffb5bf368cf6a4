/// What is fetched by GET and HEAD: from the header to the last byte of the answer. The resources work on a worker of
/// their own; here nothing waits for them.

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>

#include <boost/asio/write.hpp>
#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "daemon/transport/http_fields.hpp"
#include "daemon/transport/http_message.hpp"
#include "daemon/transport/http_routes.hpp"
#include "daemon/transport/http_session.hpp"
#include "daemon/transport/http_target.hpp"
#include "daemon/transport/reading_time.hpp"

namespace fvd {

namespace asio = boost::asio;
namespace http = boost::beast::http;

namespace {

constexpr std::chrono::seconds kStreamPieceTime{15};  // to read a piece; as long as tune() waits for its system
constexpr std::chrono::milliseconds kShortestPutOff{1};

int status_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::kUnknownJob:
      return 404;
    case ErrorCode::kResultRemoved:
      return 410;
    case ErrorCode::kBadConfig:
    case ErrorCode::kRegionOutside:
      return 400;
    case ErrorCode::kShuttingDown:
    case ErrorCode::kNotReady:
      return 503;
    default:
      return 500;
  }
}

/// The transport's own: the connection goes on.
ResourceAnswer refused(int status, std::string_view error, const std::string& message) {
  ResourceAnswer answer;
  answer.status = status;
  answer.fields = {{"Content-Type", "application/json"}};
  answer.body = HttpRefusal{status, std::string(error), message}.body();
  return answer;
}

/// Tells the log, as often as refusals at most: who fetches may do so all the time. The path and the number are no part
/// of the error's line, which is one alarm however often it comes.
void note_failure(RefusedCalls& failures, const std::string& address, const std::string& path, const std::string& why) {
  const auto count = failures.count_to_tell(address, HostClock::now());
  if (!count) return;
  spdlog::error("what is asked for by GET cannot be answered: {}", why);
  spdlog::info("that was GET {}; {} could not be answered since the last that was told", path, *count);
}

ResourceAnswer answer_of(HttpResource& resource, const ResourceRequest& request, RefusedCalls& failures) {
  try {
    return resource.get(request);
  } catch (const Error& error) {
    if (status_of(error.code()) == 500) note_failure(failures, request.address, request.path, error.what());
    return refused(status_of(error.code()), error_name(error.code()), error.what());
  } catch (const std::exception& error) {
    note_failure(failures, request.address, request.path, error.what());
    return refused(500, error_name(ErrorCode::kInternal), std::string("internal error: ") + error.what());
  }
}

/// The next piece; nothing where it cannot be had.
std::optional<std::string> next_of(BodySource& source, const ResourceRequest& request, RefusedCalls& failures) {
  try {
    return source.next();
  } catch (const std::exception& error) {
    note_failure(failures, request.address, request.path, std::string("it ends in its middle: ") + error.what());
    return std::nullopt;
  }
}

bool has_no_body(int status) { return status == 204 || status == 304; }

const std::string* field_of(const ResourceAnswer& answer, std::string_view name) {
  const auto found = std::find_if(answer.fields.begin(), answer.fields.end(),
                                  [name](const auto& field) { return field.first == name; });
  return found == answer.fields.end() ? nullptr : &found->second;
}

/// That it can be written as it is: no field begins another one.
bool is_sound(const ResourceAnswer& answer) {
  return answer.status >= 200 && answer.status <= 599 &&
         std::all_of(answer.fields.begin(), answer.fields.end(),
                     [](const auto& field) { return is_field_name(field.first) && is_field_value(field.second); });
}

/// The same without its body: the client has it.
ResourceAnswer not_modified(ResourceAnswer answer) {
  answer.status = 304;
  answer.body.clear();
  answer.source.reset();
  std::erase_if(answer.fields, [](const auto& field) { return field.first.starts_with("Content-"); });
  return answer;
}

std::string header_text(const ResourceAnswer& answer, bool keep_alive) {
  http::response<http::empty_body> response;
  response.result(static_cast<unsigned>(answer.status));
  response.set(http::field::cache_control, "no-store");
  for (const auto& [name, value] : answer.fields) response.set(name, value);
  set_common_fields(response);
  response.keep_alive(keep_alive);
  if (!answer.stream && !answer.is_endless && !has_no_body(answer.status)) {
    response.content_length(answer.source ? answer.source_bytes : answer.body.size());
  }
  std::ostringstream text;
  text << response.base();
  return text.str();
}

}  // namespace

void HttpSession::serve_get() {
  if (!parser_->is_done()) {
    return refuse({400, "bad_request", "a GET has no body; ask by the path and its query, or send a POST"});
  }
  auto target = read_target({parser_->get().target().data(), parser_->get().target().size()});
  if (const auto* refusal = std::get_if<HttpRefusal>(&target)) return refuse(*refusal);
  auto& wanted = std::get<HttpTarget>(target);
  const MountedResource* mounted = resource_for(host_.resources, wanted.path);
  if (mounted == nullptr) return refuse({404, "not_found", "there is nothing here; calls go to POST /api/jsonrpc"});
  deadline_.cancel();
  since_ = HostClock::now();
  fetch_ = Fetch{};
  fetch_->resource = mounted->resource;
  fetch_->request = resource_request();
  fetch_->request.path = std::move(wanted.path);
  fetch_->request.query = std::move(wanted.query);
  fetch_->begun = since_;
  recognise();
}

ResourceRequest HttpSession::resource_request() const {
  ResourceRequest request;
  request.is_head = is_head();
  request.takes_gzip = head_.accept_encoding && takes_gzip(*head_.accept_encoding);
  request.if_none_match = head_.if_none_match;
  request.range = head_.range;
  request.if_range = head_.if_range;
  request.last_event_id = head_.last_event_id;
  request.address = address_;
  request.has_token = has_token();
  return request;
}

void HttpSession::fetch() {
  if (fetch_->resource->needs_view() && caller_.who.role < Role::kView) {
    note_refusal("not_allowed");
    return refuse({403, "not_allowed",
                   "this caller may not look; send Authorization: Bearer TOKEN of one who may, or see rpc.allow"});
  }
  using Made = std::shared_ptr<ResourceAnswer>;
  fetch_->is_made = true;
  work<Made>(
      host_.files,
      [resource = fetch_->resource, request = fetch_->request, &failures = host_.failed_fetches] {
        return std::make_shared<ResourceAnswer>(answer_of(*resource, request, failures));
      },
      &HttpSession::take_answer);
}

void HttpSession::take_answer(std::shared_ptr<ResourceAnswer> answer) {
  if (!fetch_) return;  // given up meanwhile
  fetch_->is_made = false;
  if (answer->again_after) {
    if (!is_ending_) return put_off(*answer->again_after);
    return refuse_at_end();
  }
  send_answer(std::move(*answer));
}

void HttpSession::put_off(std::chrono::milliseconds time) {
  fetch_->is_put_off = true;
  wait_.expires_after(std::max(time, kShortestPutOff));
  wait_.async_wait([self = shared_from_this()](ErrorCodeOf error) {
    if (error || self->is_closed_ || !self->fetch_ || !self->fetch_->is_put_off) return;
    if (self->wait_.expiry() > std::chrono::steady_clock::now()) return;
    Fetch& fetch = *self->fetch_;
    fetch.is_put_off = false;
    fetch.request.waited = std::chrono::duration_cast<std::chrono::milliseconds>(HostClock::now() - fetch.begun);
    self->fetch();
  });
  if (watch_ == 0) watch_client();
}

void HttpSession::send_answer(ResourceAnswer answer) {
  if (!is_sound(answer)) {
    note_failure(host_.failed_fetches, address_, fetch_->request.path, "its status or a field of it is none");
    answer = refused(500, error_name(ErrorCode::kInternal), "internal error: an answer that cannot be sent");
  }
  const std::string* etag = field_of(answer, "ETag");
  const bool is_good = answer.status == 200 || answer.status == 206;
  if (is_good && etag != nullptr && head_.if_none_match && names_etag(*head_.if_none_match, *etag)) {
    answer = not_modified(std::move(answer));
  }
  fetch_->keep_alive = parser_->get().keep_alive() && !answer.stream;
  std::string head = header_text(answer, fetch_->keep_alive);
  if (is_head() || has_no_body(answer.status)) return send_piece(std::move(head), {});
  fetch_->source = std::move(answer.source);
  fetch_->left_bytes = fetch_->source ? answer.source_bytes : 0;
  fetch_->stream = std::move(answer.stream);
  send_piece(std::move(head), fetch_->source ? std::string() : std::move(answer.body));
}

void HttpSession::send_piece(std::string head, std::string bytes) {
  head_text_ = std::move(head);
  piece_ = std::move(bytes);
  is_sending_ = true;
  expire_after(fetch_->stream ? kStreamPieceTime : reading_time(piece_.size()));
  const std::array<asio::const_buffer, 2> both{asio::buffer(head_text_), asio::buffer(piece_)};
  asio::async_write(socket_, both, [self = shared_from_this()](ErrorCodeOf error, std::size_t) {
    if (self->is_closed_) return;
    if (error || self->timed_out_) return self->close();
    self->deadline_.cancel();
    self->is_sending_ = false;
    self->go_on();
  });
}

void HttpSession::go_on() {
  if (fetch_->stream) {
    const bool has_begun = head_text_.empty();
    return has_begun ? pump() : begin_stream();
  }
  if (fetch_->left_bytes > 0) {
    return work<Piece>(
        host_.files,
        [source = fetch_->source, request = fetch_->request, &failures = host_.failed_fetches] {
          return next_of(*source, request, failures);
        },
        &HttpSession::take_piece);
  }
  const bool keep_alive = fetch_->keep_alive;
  end_request();
  piece_ = {};
  if (keep_alive) return await_request();
  drain();
}

void HttpSession::take_piece(Piece piece) {
  // A body that is not as long as was said cannot be mended: the client sees that its end is missing.
  if (!piece || piece->empty() || piece->size() > fetch_->left_bytes) return close();
  fetch_->left_bytes -= piece->size();
  send_piece({}, *std::move(piece));
}

void HttpSession::begin_stream() {
  watch_client();
  fetch_->stream->on_ready([weak = weak_from_this(), &context = host_.context] {
    asio::post(context, [weak] {
      if (const auto self = weak.lock()) self->pump();
    });
  });
  time_ping();
  pump();
}

void HttpSession::time_ping() {
  wait_.expires_after(fetch_->stream->ping_period());
  wait_.async_wait([self = shared_from_this()](ErrorCodeOf error) {
    if (error || self->is_closed_) return;
    self->fetch_->owes_ping = true;
    self->time_ping();
    self->pump();
  });
}

void HttpSession::pump() {
  if (is_closed_ || is_sending_ || !fetch_ || !fetch_->stream) return;
  std::string bytes = fetch_->stream->next();
  if (std::exchange(fetch_->owes_ping, false)) bytes += fetch_->stream->ping();
  if (!bytes.empty()) send_piece({}, std::move(bytes));
}

}  // namespace fvd
