#pragma once

/// Results of jobs in three lengths, with their description.

#include <cstddef>

#include <nlohmann/json.hpp>

#include "config/fields.hpp"
#include "daemon/api/reply_form.hpp"
#include "daemon/store/job_status.hpp"

namespace fvd {

/// The result of a job as its form asks, within its length:
///   compact  the main values; with an evaluation its verdict and values in their place. Of what does not fit,
///            measurements give way first, from the last one on, then client, job_id, the counts of frames, heights,
///            age_s
///   full     result.json without what is long, and where the files are. focus, steps, times, slices, frames give way
///   in
///            this order, then the last of the warnings
///   complete all of result.json under the key "result", of any length
/// envelope_bytes: of the reply around it.
[[nodiscard]] nlohmann::ordered_json result_reply(const StoredJob& stored, const ReplyForm& form,
                                                  std::size_t envelope_bytes);
/// Of all three.
void describe_result(Fields& fields);
/// Of a compact result, or of none.
void describe_next_result(Fields& fields);

}  // namespace fvd
