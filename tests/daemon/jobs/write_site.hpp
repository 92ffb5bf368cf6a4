#pragma once

/// A place that writes files, and every call of it failing, in every way that disks fail.

#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <system_error>

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "tests/daemon/jobs/faulty_calls.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::test {

/// Made in an empty folder, as it is before anything is written.
class WriteSite {
 public:
  virtual ~WriteSite() = default;
  /// Writes. Throws Error where a call fails, unless keeps_failures_to_itself().
  virtual void work() = 0;
  /// What is wrong now; empty = nothing. done: the work succeeded, now or when it was repeated.
  virtual std::string wrong(bool done) = 0;
  /// What the next start does before anything else.
  virtual void clear() {}
  /// Failures are logged: what was asked for does not depend on it.
  [[nodiscard]] virtual bool keeps_failures_to_itself() const { return false; }
};

struct WriteSiteKind {
  const char* name;
  std::function<std::unique_ptr<WriteSite>(const std::filesystem::path& folder)> make;
  int stride = 1;  ///< in the short run only every such call fails
  friend std::ostream& operator<<(std::ostream& out, const WriteSiteKind& kind) { return out << kind.name; }
};

/// Each fault once, and each with all that follows it. In the short run the kinds of faults take turns.
class EveryWriteFault {
 public:
  explicit EveryWriteFault(const WriteSiteKind& kind) : kind_(kind) {}

  void run() {
    const bool all = std::getenv("FVD_ALL_WRITE_FAULTS") != nullptr;
    int turn = 0;
    for (int call = 0, reached = true; reached != 0; call += all ? 1 : kind_.stride) {
      ASSERT_LT(call, 3000);
      const int last = all ? kKinds : 1;
      for (int i = 0; i < last && reached != 0; ++i) {
        const int which = turn++ % kKinds;
        reached = try_fault(call, kErrors.at(static_cast<std::size_t>(which) % kErrors.size()),
                            which < kKinds / 2 ? FaultLasts::kOnce : FaultLasts::kUntilMended)
                      ? 1
                      : 0;
      }
    }
    EXPECT_GT(faults_, 0) << "nothing goes through FileCalls here";
    std::cout << "{\"write_faults\": " << faults_ << ", \"write_fault_violations\": " << violations_ << "}"
              << std::endl;
  }

 private:
  static constexpr std::array kErrors{ENOSPC, EIO, EROFS};
  static constexpr int kKinds = 6;

  /// False: there is no such call.
  bool try_fault(int call, int reason, FaultLasts lasts) {
    const ScratchDir folder;
    const auto site = kind_.make(folder.path());
    FaultyCalls calls(call, reason, lasts);
    std::string refusal;
    bool refused = false;
    try {
      const ReplacedFileCalls replaced(calls);
      site->work();
    } catch (const Error& error) {
      refused = true;
      refusal = what_is_wrong_with(error, reason, folder.path());
    }
    const std::string where = std::string(kind_.name) + ", call " + std::to_string(call) + ", " +
                              std::generic_category().message(reason) +
                              (lasts == FaultLasts::kOnce ? " once" : " from then on");
    judge(refusal, where);
    if (!calls.has_failed()) {
      judge(refused ? "it was refused without a fault" : site->wrong(true), where);
      return false;
    }
    ++faults_;
    // What clears up fails too where the fault lasts: then the next start does it.
    if (lasts == FaultLasts::kOnce) judge(site->wrong(!refused && !site->keeps_failures_to_itself()), where);
    site->clear();
    judge(site->wrong(!refused && !site->keeps_failures_to_itself()), where + ", at the next start");
    if (!refused && !site->keeps_failures_to_itself()) return true;
    try {
      site->work();
      site->clear();
      judge(site->wrong(true), where + ", repeated");
    } catch (const Error& error) {
      judge(std::string("refused: ") + error.what(), where + ", repeated");
    }
    return true;
  }

  static std::string what_is_wrong_with(const Error& error, int reason, const std::filesystem::path& folder) {
    const std::string text = error.what();
    const ErrorCode expected = reason == ENOSPC ? ErrorCode::kStorageFull : ErrorCode::kStorageWrite;
    if (error.code() != expected) return "another code: " + text;
    if (text.find(folder.string()) == std::string::npos) return "it names no file: " + text;
    if (text.find(std::generic_category().message(reason)) == std::string::npos) return "it names no cause: " + text;
    return {};
  }
  void judge(const std::string& problem, const std::string& where) {
    if (problem.empty()) return;
    ++violations_;
    ADD_FAILURE() << where << ": " << problem;
  }

  const WriteSiteKind& kind_;
  int faults_ = 0;
  int violations_ = 0;
};

class AWriteSite : public testing::TestWithParam<WriteSiteKind> {};

template <typename Site>
WriteSiteKind write_site(const char* name, int stride = 1) {
  return {name, [](const std::filesystem::path& folder) { return std::make_unique<Site>(folder); }, stride};
}

}  // namespace fvd::test
