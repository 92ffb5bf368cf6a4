/// Requests for maps, files and the live picture: path, Range, If-None-Match, If-Range, then keys and values of the
/// query, which NUL bytes separate in the input.

#include <set>

#include "core/base/error.hpp"
#include "daemon/export/result_writer.hpp"
#include "daemon/resources/job_resource.hpp"
#include "daemon/resources/live_resource.hpp"
#include "tests/daemon/export/sample_result.hpp"
#include "tests/daemon/resources/fake_results.hpp"
#include "tests/daemon/views/fake_pictures.hpp"
#include "tests/fuzz/fuzz_input.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::test {

namespace {

/// One job, J7, and a secret beside its folder.
class Station {
 public:
  Station() {
    ResultData data = sample_result();
    data.map = sample_map(40, 30);
    data.exports = {"tiff", "mask.png", "texture.png"};
    write_result(folder_ / "J7", data);
    write_text(folder_ / "secret", "SECRET");
    StoredJob job;
    job.status.job_id = "J7";
    job.status.state = JobState::kCompleted;
    job.result_dir = folder_ / "J7";
    job.result_json = read_text(folder_ / "J7" / "result.json");
    results_.add(job);
    pictures_.show(3);
  }

  ResourceAnswer answer(const ResourceRequest& request) {
    if (request.path.starts_with(kLivePath)) return live_.get(request);
    return jobs_.get(request);
  }

 private:
  ScratchDir folder_;
  FakeResults results_;
  FakePictures pictures_;
  JobResource jobs_{results_};
  LiveResource live_{pictures_};
};

ResourceRequest request_in(std::string_view input) {
  const auto parts = parts_of(input, '\0');
  const auto part = [&parts](std::size_t i) { return i < parts.size() ? std::string(parts[i]) : std::string(); };
  const auto field = [&part](std::size_t i) { return part(i).empty() ? std::nullopt : std::optional(part(i)); };
  ResourceRequest request;
  request.path = part(0);
  request.range = field(1);
  request.if_none_match = field(2);
  request.if_range = field(3);
  for (std::size_t i = 4; i + 1 < parts.size(); i += 2) request.query.emplace(part(i), part(i + 1));
  return request;
}

/// As many bytes as are told, in pieces that are not too large, and nothing that is not the job's.
void check_body(ResourceAnswer& answer) {
  std::string body = answer.body;
  if (answer.source) {
    for (std::string piece = answer.source->next(); !piece.empty(); piece = answer.source->next()) {
      require(piece.size() <= 256U << 10U);
      body += piece;
    }
    require(body.size() == answer.source_bytes);
  }
  require(body.find("SECRET") == std::string::npos);
}

/// No field ends early, whatever was asked for.
void check_fields(const ResourceAnswer& answer) {
  for (const auto& [name, text] : answer.fields) {
    for (const char c : name + text) require(static_cast<unsigned char>(c) >= 0x20 && c != 0x7F);
  }
}

}  // namespace

}  // namespace fvd::test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace fvd;
  using namespace fvd::test;
  static Station station;
  const ResourceRequest request = request_in(text_of({bytes, size}));
  try {
    ResourceAnswer answer = station.answer(request);
    static const std::set<int> kKnown{200, 206, 304, 400, 404, 416};
    require(kKnown.contains(answer.status));
    check_fields(answer);
    check_body(answer);
  } catch (const Error& error) {
    require(error.code() == ErrorCode::kUnknownJob);
  }
  return 0;
}
