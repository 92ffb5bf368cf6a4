#include "daemon/store/evaluation_table.hpp"

namespace fvd {

std::string evaluation_id(const std::string& job_id, std::int64_t number) {
  return job_id + "-e" + std::to_string(number);
}

std::optional<StoredEvaluation> EvaluationTable::find(const std::string& id) const {
  const MutexLock lock(reader_.mutex);
  Statement rows(reader_.database,
                 "SELECT evaluation_id, job_id, number, recipe, recipe_sha256, verdict, result_dir, result_json "
                 "FROM evaluations WHERE evaluation_id = ?");
  rows.bind(id);
  if (!rows.step()) return std::nullopt;
  return StoredEvaluation{.id = rows.text(0),
                          .job_id = rows.text(1),
                          .number = rows.integer(2),
                          .recipe = rows.text(3),
                          .recipe_sha256 = rows.text(4),
                          .verdict = rows.text(5),
                          .result_dir = rows.text(6),
                          .result_json = rows.text(7)};
}

std::int64_t EvaluationTable::newest_number(const std::string& job_id) const {
  const MutexLock lock(reader_.mutex);
  Statement rows(reader_.database, "SELECT coalesce(max(number), 0) FROM evaluations WHERE job_id = ?");
  rows.bind(job_id);
  return rows.step() ? rows.integer(0) : 0;
}

void EvaluationTable::add(const StoredEvaluation& evaluation) {
  const MutexLock lock(writer_.mutex);
  Transaction transaction(writer_.database);
  Statement(writer_.database,
            "INSERT INTO evaluations (evaluation_id, job_id, number, recipe, recipe_sha256, verdict, result_dir, "
            "result_json) VALUES (?, ?, ?, ?, ?, ?, ?, ?)")
      .bind(evaluation.id)
      .bind(evaluation.job_id)
      .bind(evaluation.number)
      .bind(evaluation.recipe)
      .bind(evaluation.recipe_sha256)
      .bind(evaluation.verdict)
      .bind(evaluation.result_dir)
      .bind(evaluation.result_json)
      .run();
  transaction.commit();
}

}  // namespace fvd
