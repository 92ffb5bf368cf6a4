#include "daemon/study/study_book.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <system_error>
#include <utility>

#include <spdlog/spdlog.h>

#include "config/strict_json.hpp"
#include "core/base/error.hpp"
#include "daemon/export/atomic_directory.hpp"
#include "daemon/export/durable_file.hpp"
#include "daemon/export/file_calls.hpp"
#include "daemon/export/json_values.hpp"
#include "daemon/study/studies.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

constexpr const char* kPrefix = "study-";

std::string id_of(int number) {
  char text[32];
  std::snprintf(text, sizeof text, "study-%04d", number);
  return text;
}

/// Of a folder's name; nothing for what is none of ours.
std::optional<int> number_of_id(const std::string& name) {
  constexpr std::size_t kMostDigits = 9;
  const std::string prefix = kPrefix;
  if (!name.starts_with(prefix)) return std::nullopt;
  const std::string digits = name.substr(prefix.size());
  if (digits.empty() || digits.size() > kMostDigits) return std::nullopt;
  if (digits.find_first_not_of("0123456789") != std::string::npos) return std::nullopt;
  const int number = std::stoi(digits);
  return id_of(number) == name ? std::optional(number) : std::nullopt;
}

}  // namespace

StudyBook::StudyBook(fs::path folder) : folder_(std::move(folder)) {
  if (!fs::exists(folder_)) return;
  remove_abandoned_directories(folder_);
  const MutexLock lock(mutex_);
  for (const auto& entry : fs::directory_iterator(folder_)) {
    const auto number = number_of_id(entry.path().filename().string());
    if (!number) continue;
    last_ = std::max(last_, *number);
    const fs::path file = entry.path() / "study.json";
    try {
      Study study = read_study_json(read_text_file(file, kAnyLength), file.string());
      if (study.id != id_of(*number)) throw Error(ErrorCode::kBadInput, file.string() + ": /id: is " + study.id);
      studies_.emplace(*number, std::move(study));
    } catch (const Error& error) {
      spdlog::warn("study {} cannot be used: {}", id_of(*number), error.what());
      broken_.emplace(*number, BrokenStudy{id_of(*number), error.what()});
    }
  }
}

Study StudyBook::keep(StudyDraft draft, const std::function<std::string(const Study&)>& report) {
  const MutexLock keeping(keeping_);
  take_back_refused();
  int number = next_number();
  // One that was refused, and that the disk would not take back.
  for (std::error_code error; fs::exists(folder_ / id_of(number), error);) ++number;
  (void)make_directories(folder_);
  Study study = std::move(draft.study);
  study.id = id_of(number);
  study.time = iso8601_utc(std::chrono::system_clock::now());
  study.files.clear();
  for (const StudyFile& file : draft.files) study.files.push_back(file.name);
  study.files.emplace_back("report.pdf");
  const std::string text = study_json_text(study);
  try {
    study = read_study_json(text, study.id);
  } catch (const Error& unreadable) {
    throw Error(ErrorCode::kStudyRefused, std::string("the study's figures are of no use: ") + unreadable.what());
  }
  AtomicDirectory directory(folder_ / study.id);
  for (const StudyFile& file : draft.files) directory.add_file(file.name, file.bytes);
  directory.add_file("report.pdf", report(study));
  directory.add_file("study.json", text);
  try {
    directory.commit();
  } catch (...) {
    refused_.insert(number);
    take_back_refused();
    throw;
  }
  const MutexLock lock(mutex_);
  last_ = number;
  studies_.emplace(number, study);
  return study;
}

StudyBook::~StudyBook() {
  const MutexLock keeping(keeping_);
  take_back_refused();
}

void StudyBook::take_back_refused() noexcept {
  std::erase_if(refused_, [this](int number) {
    // Hidden first: a start clears what is left of it.
    const fs::path folder = folder_ / id_of(number);
    const fs::path hidden = folder_ / ("." + id_of(number) + ".refused.tmp");
    file_calls().remove_all(hidden);  // of the same number before
    if (file_calls().rename(folder, hidden) == 0) file_calls().remove_all(hidden);
    std::error_code error;
    return !fs::exists(folder, error) && !error;
  });
}

int StudyBook::next_number() const {
  const MutexLock lock(mutex_);
  return last_ + 1;
}

Study StudyBook::get(const std::string& id) const {
  const MutexLock lock(mutex_);
  const auto number = number_of_id(id);
  if (number) {
    if (const auto found = studies_.find(*number); found != studies_.end()) return found->second;
    if (const auto found = broken_.find(*number); found != broken_.end()) {
      throw Error(ErrorCode::kStudyRefused, id + " cannot be read: " + found->second.reason);
    }
  }
  throw Error(ErrorCode::kStudyRefused, "there is no study '" + id + "'; study.list tells those that there are");
}

std::vector<Study> StudyBook::list() const {
  const MutexLock lock(mutex_);
  std::vector<Study> all;
  for (auto study = studies_.rbegin(); study != studies_.rend(); ++study) all.push_back(study->second);
  return all;
}

std::vector<BrokenStudy> StudyBook::broken() const {
  const MutexLock lock(mutex_);
  std::vector<BrokenStudy> all;
  for (const auto& [unused, study] : broken_) all.push_back(study);
  return all;
}

std::map<std::string, Repeatability> StudyBook::newest_repeatability(const std::string& recipe_id,
                                                                     const std::string& objective,
                                                                     bool simulated) const {
  std::map<std::string, Repeatability> newest;
  if (recipe_id.empty()) return newest;  // of jobs with different recipes
  const MutexLock lock(mutex_);
  for (auto at = studies_.rbegin(); at != studies_.rend(); ++at) {
    const Study& study = at->second;
    if (study.recipe_id != recipe_id || !study.kind.starts_with("gauge.")) continue;
    if (study.objective != objective || study.simulated != simulated) continue;
    try {
      const auto found = repeatability_of(study);
      if (found) newest.emplace(found->name, Repeatability{found->sd, found->dof, study.id});
    } catch (const Error& error) {
      spdlog::warn("{} gives no repeatability: {}", study.id, error.what());
    }
  }
  return newest;
}

}  // namespace fvd
