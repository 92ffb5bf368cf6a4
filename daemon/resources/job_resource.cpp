#include "daemon/resources/job_resource.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include "core/base/error.hpp"
#include "daemon/resources/answers.hpp"
#include "daemon/resources/byte_range.hpp"
#include "daemon/resources/entity_tag.hpp"
#include "daemon/resources/file_fields.hpp"
#include "daemon/resources/file_stream.hpp"
#include "daemon/resources/height_query.hpp"
#include "daemon/resources/view_stream.hpp"
#include "daemon/views/map_owner.hpp"
#include "daemon/views/result_file.hpp"

namespace fvd {

namespace {

constexpr const char* kForEver = "private, max-age=31536000, immutable";
constexpr const char* kAskAgain = "private, no-cache";  // result.json is replaced when its last files are made
constexpr std::size_t kLongestId = 64;
/// What is made at once; a larger view is made while it is sent.
constexpr std::uint64_t kHeldBody_bytes = std::uint64_t{4} << 20U;

bool is_job_id(std::string_view id) {
  const auto is_known = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' ||
           c == '.';
  };
  return !id.empty() && id.size() <= kLongestId && !id.starts_with('.') && std::all_of(id.begin(), id.end(), is_known);
}

ResourceAnswer no_such_path() {
  return refused({404, "not_found", "there are GET /api/v1/jobs/ID/height and GET /api/v1/jobs/ID/files/NAME"});
}

ResourceAnswer no_result() {
  return refused({404, "no_result", "the job has no result: job.status tells how it ended, or that it runs"});
}

std::string height_tag(const std::string& file_tag, const HeightQuery& query, const ViewWindow& window) {
  std::string tag = "\"" + file_tag + "-" + std::string(map_kind_name(query.kind));
  for (const int number : {window.x, window.y, window.width, window.height, query.most}) {
    tag += "-" + std::to_string(number);
  }
  return tag + "\"";
}

/// The bytes of an opened file, or of the range of it that is asked for.
ResourceAnswer bytes_of(OpenedFile opened, const std::string& etag, const ResourceRequest& request) {
  ResourceAnswer answer;
  ByteRange sent{0, opened.size_bytes - 1};
  // Of other methods than GET a range means nothing; nor does one of a file that has changed since.
  const bool has_range =
      request.range && !request.is_head && (!request.if_range || is_same_entity(*request.if_range, etag));
  const std::string of_all = "/" + std::to_string(opened.size_bytes);
  if (has_range) {
    const auto range = byte_range(*request.range, opened.size_bytes);
    if (std::holds_alternative<RangeBeyond>(range)) {
      answer = refused({416, "no_such_range", "the file has " + std::to_string(opened.size_bytes) + " bytes"});
      answer.fields.emplace_back("Content-Range", "bytes *" + of_all);
      return answer;
    }
    if (const auto* part = std::get_if<ByteRange>(&range)) {
      sent = *part;
      answer.status = 206;
      answer.fields.emplace_back("Content-Range",
                                 "bytes " + std::to_string(sent.first) + "-" + std::to_string(sent.last) + of_all);
    }
  }
  if (opened.size_bytes == 0) return answer;
  answer.source_bytes = sent.bytes();
  answer.source = std::make_unique<FileStream>(std::move(opened.file), sent.first, answer.source_bytes);
  return answer;
}

}  // namespace

ResourceAnswer JobResource::get(const ResourceRequest& request) {
  std::string_view path = request.path;
  if (!path.starts_with(kJobsPath)) return no_such_path();
  path.remove_prefix(std::string_view(kJobsPath).size());
  const auto end_of_id = path.find('/');
  if (end_of_id == std::string_view::npos) return no_such_path();
  const std::string_view id = path.substr(0, end_of_id);
  const std::string_view what = path.substr(end_of_id + 1);
  constexpr std::string_view kFiles = "files/";
  const bool is_height = what == "height";
  if (!is_height && !what.starts_with(kFiles)) return no_such_path();
  if (!is_job_id(id)) throw Error(ErrorCode::kUnknownJob, "there is no such job: job.latest tells the newest");
  if (is_height) return height(std::string(id), request);
  return file(std::string(id), what.substr(kFiles.size()), request);
}

ResourceAnswer JobResource::height(const std::string& id, const ResourceRequest& request) {
  const auto read = read_height_query(request.query);
  if (const auto* wrong = std::get_if<std::string>(&read)) return refused({400, "bad_query", *wrong});
  const auto& query = std::get<HeightQuery>(read);
  const auto owner = map_owner(results_, id, maps_);
  if (!owner) return no_result();
  const auto map = maps_.of(owner->status.job_id, owner->result_dir)->find(query.kind);
  if (!map) {
    return refused(
        {404, "no_map",
         "the result has no file of " + std::string(map_kind_name(query.kind)) + ": the recipe's export left it out"});
  }
  const GridSize size = map->rows->size();
  const auto window = window_in(query, size);
  if (!window) {
    return refused({400, "outside",
                    "the window leaves the map, which has " + std::to_string(size.width) + " x " +
                        std::to_string(size.height) + " points"});
  }
  const std::string etag = height_tag(map->tag, query, *window);
  if (request.if_none_match && names_entity(*request.if_none_match, etag)) return not_modified(etag, kForEver);
  const BlockValue value = query.kind == MapKind::kReason ? BlockValue::kCommonest : BlockValue::kMean;
  HeightView view(map->rows, *window, query.most, value);
  ResourceAnswer answer;
  answer.fields = {{"Content-Type", "application/octet-stream"}, {"ETag", etag}, {"Cache-Control", kForEver}};
  if (request.is_head || view.bytes() > kHeldBody_bytes) {
    answer.source_bytes = view.bytes();
    answer.source = std::make_unique<ViewStream>(std::move(view));
  } else {
    answer.body = view.whole();
  }
  return answer;
}

ResourceAnswer JobResource::file(const std::string& id, std::string_view name, const ResourceRequest& request) const {
  const StoredJob job = results_.stored(id);
  require_not_removed(job.status);
  if (job.result_dir.empty() || job.result_json.empty()) return no_result();
  auto found = open_result_file(job, name);
  if (const auto* none = std::get_if<NoFile>(&found)) return refused({404, none->error, none->message});
  auto& opened = std::get<OpenedFile>(found);
  const std::string etag = "\"" + opened.tag + "\"";
  if (request.if_none_match && names_entity(*request.if_none_match, etag)) return not_modified(etag, kAskAgain);
  ResourceAnswer answer = bytes_of(std::move(opened), etag, request);
  if (answer.status == 416) return answer;
  answer.fields.emplace_back("Content-Type", content_type_of(name));
  answer.fields.emplace_back("Content-Disposition", content_disposition(name));
  answer.fields.emplace_back("Accept-Ranges", "bytes");
  answer.fields.emplace_back("ETag", etag);
  answer.fields.emplace_back("Cache-Control", kAskAgain);
  return answer;
}

}  // namespace fvd
