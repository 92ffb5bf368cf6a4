#include "daemon/study/study_book.hpp"

#include <cerrno>
#include <optional>

#include <gtest/gtest.h>

#include "daemon/export/file_calls.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

namespace fs = std::filesystem;

/// A disk that fails once the first study has its name, and then takes nothing until it is mended.
class FailingAtTheEnd final : public FileCalls {
 public:
  int sync_directory(const fs::path& path) override {
    broken_ = broken_ || fs::exists(path / "study-0001");
    return fails() ? -1 : FileCalls::sync_directory(path);
  }
  int rename(const fs::path& from, const fs::path& to) override { return fails() ? -1 : FileCalls::rename(from, to); }
  void remove_all(const fs::path& path) noexcept override {
    if (!fails()) FileCalls::remove_all(path);
  }
  void mend() { mended_ = true; }

 private:
  [[nodiscard]] bool fails() const {
    errno = EIO;
    return broken_ && !mended_;
  }
  bool broken_ = false;
  bool mended_ = false;
};

class ARefusedStudy : public testing::Test {
 protected:
  ARefusedStudy() {
    FVD_EXPECT_ERROR(kStorageWrite, (void)keep());
    EXPECT_TRUE(fs::exists(studies_ / "study-0001")) << "the disk did not take it back";
    EXPECT_TRUE(book_->list().empty());
    disk_.mend();
  }
  Study keep() {
    StudyDraft draft;
    draft.study.kind = "verify.noise";
    draft.study.jobs = {"J7"};
    return book_->keep(std::move(draft), [](const Study&) { return std::string("pdf"); });
  }
  const test::ScratchDir folder_;
  const fs::path studies_ = folder_ / "studies";
  FailingAtTheEnd disk_;
  const ReplacedFileCalls replaced_{disk_};
  std::optional<StudyBook> book_{studies_};
};

TEST_F(ARefusedStudy, IsTakenBackBeforeTheNextIsKept) {
  const Study kept = keep();
  EXPECT_EQ(StudyBook(studies_).list(), std::vector<Study>{kept});
}

TEST_F(ARefusedStudy, IsTakenBackAtTheEnd) {
  book_.reset();
  EXPECT_TRUE(StudyBook(studies_).list().empty());
}

}  // namespace
}  // namespace fvd
