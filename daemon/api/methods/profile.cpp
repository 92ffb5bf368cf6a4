/// Heights along a line across a stored result.

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "daemon/api/methods/methods.hpp"
#include "daemon/api/replies.hpp"
#include "daemon/api/result_fields.hpp"
#include "daemon/export/result_json.hpp"
#include "daemon/views/line_profile.hpp"
#include "daemon/views/map_cache.hpp"
#include "daemon/views/map_owner.hpp"

namespace fvd {

namespace {

constexpr double kFarthest_um = 1e6;
constexpr double kDigits = 1e10;  // parts of a um that a reply tells: far below what heights of 32 bit hold

struct LineEnd {
  double x_um = 0.0;
  double y_um = 0.0;

  void describe(Fields& fields, std::string_view name, std::string_view meaning) {
    fields.group(name, meaning, [this](Fields& in) {
      in.number("x", x_um, {-kFarthest_um, kFarthest_um}, "um to the right, from the outer corner of the first point");
      in.require("x");
      in.number("y", y_um, {-kFarthest_um, kFarthest_um}, "um down");
      in.require("y");
    });
    fields.require(name);
  }
};

struct ProfileParams {
  std::string job_id;
  LineEnd from;
  LineEnd to;
  double width_um = 0.0;

  void describe(Fields& fields) {
    fields.text("job_id", job_id, kMaxForeignText_bytes, "the job, or an evaluation of its surface");
    fields.require("job_id");
    from.describe(fields, "from_um", "where the line begins, in the map");
    to.describe(fields, "to_um", "where it ends");
    fields.number("width_um", width_um, {0.0, kFarthest_um},
                  "of the band across the line, which is averaged; below one point: the line alone. Line and band have "
                  "2,000,000 samples, one point apart, at most");
  }
};

void describe_profile(Fields& fields) {
  const ResultFields result(fields);
  result.any("distance_um",
             "a list: from the line's start to each point of the profile, about one point of the map apart");
  result.any("height_um",
             "a list of as many, as an evaluation takes them: bilinear between points, mean over the band, divided by "
             "alpha_z where the result was calibrated; null where a point is missing");
  result.any("sigma_um",
             "a list of as many: standard error of a single point, mean over the band; null where it is "
             "not known");
}

Reply listed(const std::vector<double>& values) {
  Reply list = Reply::array();
  for (const double value : values) {
    list.push_back(std::isfinite(value) ? Reply(std::round(value * kDigits) / kDigits) : Reply(nullptr));
  }
  return list;
}

metrology::ProfileLine line_of(const ProfileParams& params) {
  metrology::ProfileLine line;
  line.from_x_um = params.from.x_um;
  line.from_y_um = params.from.y_um;
  line.to_x_um = params.to.x_um;
  line.to_y_um = params.to.y_um;
  line.band_width_um = params.width_um;
  return line;
}

Reply profile_of(const ResultService& results, MapCache& maps, const ProfileParams& params) {
  const std::optional<StoredJob> job = map_owner(results, params.job_id, maps);
  if (!job) {
    throw Error(ErrorCode::kBadInput,
                "job " + quoted(params.job_id) + " has no result: job.status tells how it ended, or that it runs");
  }
  const Result result = read_result_json(job->result_json);
  const LineProfile profile = line_profile(*maps.of(job->status.job_id, job->result_dir), result, line_of(params));
  return Reply{{"distance_um", listed(profile.distance_um)},
               {"height_um", listed(profile.height_um)},
               {"sigma_um", listed(profile.sigma_um)}};
}

}  // namespace

void add_profile_methods(MethodTable& methods, const Services& services) {
  using enum ErrorCode;
  // Whoever drags a line asks many times for the same result.
  const auto maps = std::make_shared<MapCache>(MapCache::Limits{.results = 1});
  methods["result.profile"] = {
      .about = {.summary = "Heights and standard errors along a line across a result's map",
                .role = Role::kView,
                .params = described<ProfileParams>(),
                .result = describe_profile,
                .errors = {kUnknownJob, kResultRemoved, kBadInput, kRegionOutside, kSurfaceFile},
                .is_long = true},
      .run = with<ProfileParams>([&results = services.results, maps](const Call&, const ProfileParams& params) {
        return profile_of(results, *maps, params);
      })};
}

}  // namespace fvd
