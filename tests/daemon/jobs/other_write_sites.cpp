/// Every other place that writes: recipes, constants, studies, backups, the setup, what clients on the machine look
/// for.

#include <algorithm>
#include <vector>

#include "daemon/backup/backup.hpp"
#include "daemon/backup/restore.hpp"
#include "daemon/calibration/calibration_book.hpp"
#include "daemon/export/ome_tiff.hpp"
#include "daemon/export/stage_report_files.hpp"
#include "daemon/recipes/recipe_book.hpp"
#include "daemon/setup/setup_files.hpp"
#include "daemon/store/job_store.hpp"
#include "daemon/study/study_book.hpp"
#include "daemon/transport/port_file.hpp"
#include "tests/daemon/jobs/write_site.hpp"

namespace fvd {
namespace {

namespace fs = std::filesystem;
using test::AWriteSite;
using test::WriteSite;

std::string recipe_of(int slices) {
  return R"({"scan": {"start_um": 0, "step_um": 1, "slices": )" + std::to_string(slices) + "}}";
}

class ARecipe final : public WriteSite {
 public:
  explicit ARecipe(const fs::path& folder) : folder_(folder), store_(folder / "fvd.sqlite") {
    fs::create_directory(folder / "shipped");
    test::write_text(folder / "shipped" / "part.json", recipe_of(11));
  }
  void work() override { (void)book_.save({"part", recipe_of(12), 0, "anna", ""}); }
  std::string wrong(bool done) override {
    const int slices = book_.load("part").slices;
    if (slices != (done ? 12 : 11)) return "it has " + std::to_string(slices) + " slices";
    if (book_.versions("part").size() != (done ? 1U : 0U)) return "its versions do not fit its text";
    if (fs::exists(folder_ / "edited" / "part.json") != done) return "its file does not fit its version";
    return {};
  }
  void clear() override { book_.~RecipeBook(), new (&book_) RecipeBook(make()); }

 private:
  [[nodiscard]] RecipeBook make() {
    return {{folder_ / "shipped", folder_ / "edited"},
            {Micrometers{-10}, Micrometers{100}, Micrometers{5}, 1000.0},
            store_.recipe_versions()};
  }
  const fs::path folder_;
  JobStore store_;
  RecipeBook book_ = make();
};

class SomeConstants final : public WriteSite {
 public:
  explicit SomeConstants(const fs::path& folder) : folder_(folder / "calibration"), book_(folder_) {}
  void work() override {
    (void)book_.add("10x", [](Calibration& next) {
      next.noise = NoiseConstants{0.05, {}};
      return std::vector<CalibrationFile>{{next.id + "-a.gsf", "bytes"}};
    });
  }
  std::string wrong(bool done) override {
    const CalibrationBook again(folder_);  // a version that was in force stays, whatever came of the flush
    if (again.versions().size() != book_.versions().size()) return "memory and file differ";
    for (const Calibration& version : again.versions()) {
      if (test::read_text(folder_ / (version.id + "-a.gsf")) != "bytes") return version.id + " lacks its file";
    }
    return done && again.versions().empty() ? "there is no version" : "";
  }

 private:
  const fs::path folder_;
  CalibrationBook book_;
};

class AStudy final : public WriteSite {
 public:
  explicit AStudy(const fs::path& folder) : folder_(folder / "studies"), book_(folder_) {}
  void work() override {
    StudyDraft draft;
    draft.study.kind = "verify.noise";
    draft.study.jobs = {"J7"};
    draft.files.push_back({"map.gsf", "bytes"});
    (void)book_.keep(std::move(draft), [](const Study&) { return std::string("pdf"); });
  }
  void clear() override {
    if (fs::exists(folder_)) remove_abandoned();
  }
  std::string wrong(bool done) override {
    const StudyBook again(folder_);
    if (!again.broken().empty()) return again.broken().front().reason;
    if (book_.list().size() != (done ? 1U : 0U)) return "it is not known";
    // Where the disk takes nothing back a whole one that was refused stays until the disk is mended.
    const std::vector<Study> all = again.list();
    for (const Study& study : book_.list()) {
      if (std::find(all.begin(), all.end(), study) == all.end()) return "studies and files differ";
    }
    return all.size() <= book_.list().size() + (done ? 0 : 1) ? "" : "studies are left";
  }

 private:
  void remove_abandoned() { const StudyBook start(folder_); }
  const fs::path folder_;
  StudyBook book_;
};

/// An instrument with one of each, and a result.
struct Instrument {
  explicit Instrument(const fs::path& in)
      : paths{in / "state", in / "recipes", in / "config" / "fvd.json", in / "drive.json", in / "tokens"} {
    fs::create_directories(paths.state_dir / "calibration");
    fs::create_directories(paths.recipe_dir / "masks");
    fs::create_directories(paths.config_file.parent_path() / "conf.d");
    for (const fs::path& file :
         {paths.state_dir / "calibration" / "calibration.json", paths.recipe_dir / "part.json",
          paths.recipe_dir / "other.json", paths.recipe_dir / "masks" / "a.png", paths.config_file,
          paths.config_file.parent_path() / "conf.d" / "10.json", paths.stage_profile, paths.token_file}) {
      test::write_text(file, "{}");
    }
    JobStore store(paths.state_dir / "fvd.sqlite");
    JobStatus job = store.accept({7, "part", "chapter"});
    job.state = JobState::kCompleted;
    result = paths.state_dir / "results" / job.job_id;
    fs::create_directories(result);
    test::write_text(result / "result.json", "{}");
    store.finish(job, result.string(), "{}");
  }
  InstrumentPaths paths;
  fs::path result;
};

class ABackup final : public WriteSite {
 public:
  explicit ABackup(const fs::path& folder) : instrument_(folder / "instrument"), to_(folder / "backup" / "today") {
    fs::create_directories(to_.parent_path());
  }
  void work() override {
    refused_ = true;
    (void)make_backup(instrument_.paths, to_, true);
    refused_ = false;
  }
  /// By whoever made it, as its refusal says.
  void clear() override {
    fs::remove_all(to_.string() + ".tmp");
    if (refused_) fs::remove_all(to_);
  }
  std::string wrong(bool done) override {
    if (fs::exists(to_.string() + ".tmp")) return "a part is left";
    if (!done) return fs::exists(to_) ? "a backup is there that was refused" : "";
    for (const fs::path& file :
         {to_ / "fvd.sqlite", to_ / "fvd.json", to_ / "conf.d" / "10.json", to_ / "recipes" / "part.json",
          to_ / "state" / "calibration" / "calibration.json", to_ / "stage_profile.json", to_ / "tokens",
          to_ / "results" / instrument_.result.filename() / "result.json"}) {
      if (!fs::exists(file)) return file.string() + " is missing";
    }
    return {};
  }

 private:
  const Instrument instrument_;
  const fs::path to_;
  bool refused_ = false;
};

class ARestoration final : public WriteSite {
 public:
  explicit ARestoration(const fs::path& folder) : instrument_(folder / "instrument"), from_(folder / "backup") {
    (void)make_backup(instrument_.paths, from_, true);
    JobStore store(database());
    (void)store.accept({8, "part", "chapter"});
    epoch_ = store.epoch();
    fs::remove_all(instrument_.result);
    const InstrumentPaths& paths = instrument_.paths;
    missing_ = {paths.recipe_dir / "part.json",
                paths.recipe_dir / "other.json",
                paths.recipe_dir / "masks" / "a.png",
                paths.config_file,
                paths.config_file.parent_path() / "conf.d" / "10.json",
                paths.stage_profile,
                paths.token_file};
    for (const fs::path& file : missing_) fs::remove(file);
    fs::remove(paths.recipe_dir / "masks");  // the folder itself stays, empty
    fs::remove_all(paths.config_file.parent_path());
  }
  void work() override { (void)restore_backup(from_, instrument_.paths); }
  std::string wrong(bool done) override {
    if (!fs::exists(database())) return done ? "there is no database" : "";  // and no daemon starts
    JobStore store(database());
    if (store.epoch() <= epoch_) return "an epoch runs twice";
    epoch_ = store.epoch();
    // The database comes last: whatever failed, all that it tells of is there.
    const bool is_restored = !knows(store, 8);
    if (done && !is_restored) return "the old database is in force";
    if (!knows(store, 7)) return "neither database";
    if (is_restored && !fs::exists(instrument_.result / "result.json")) return "the result is not back";
    for (const fs::path& file : missing_) {
      if (is_restored && !(fs::exists(file) && test::read_text(file) == "{}")) return file.string() + " is not back";
    }
    try {
      (void)store.accept({8, "part", "chapter"});
      return "a number runs twice";
    } catch (const Error&) {
      return {};
    }
  }

 private:
  static bool knows(const JobStore& store, std::int64_t seq) {
    try {
      return !store.find(ClientSeq{seq}).status.job_id.empty();
    } catch (const Error&) {
      return false;
    }
  }
  [[nodiscard]] fs::path database() const { return instrument_.paths.state_dir / "fvd.sqlite"; }
  const Instrument instrument_;
  const fs::path from_;
  std::vector<fs::path> missing_;
  std::int64_t epoch_ = 0;
};

class APortFile final : public WriteSite {
 public:
  explicit APortFile(const fs::path& folder) : file_(folder / "run" / "rpc.json") {}
  void work() override { write_port_file(file_, "127.0.0.1", 4711, "/run/fvd/rpc.sock"); }
  std::string wrong(bool done) override {
    const bool whole = fs::exists(file_) && test::read_text(file_).ends_with("}\n");
    return whole || (!done && !fs::exists(file_)) ? "" : "the file is not whole";
  }

 private:
  const fs::path file_;
};

/// In place of an older configuration, with a trial's recipe.
class ASetup final : public WriteSite {
 public:
  explicit ASetup(const fs::path& folder) : folder_(folder / "etc"), file_(folder_ / "fvd.json") {
    fs::create_directory(folder_);
    test::write_text(file_, "{}");
    draft_.devices.camera.address = "192.168.10.20";
    draft_.devices.stage.profile = FVD_SOURCE_DIR "/config/drives/oriental-az.json";
    draft_.devices.stage.address = "192.168.20.30";
    draft_.trial = TrialRange{0.0, 5.0, 3};
  }
  void work() override { (void)write_setup(draft_, file_, true); }
  std::string wrong(bool done) override {
    const bool is_new = test::read_text(file_) != "{}";
    const bool has_recipe = fs::exists(folder_ / "recipes" / "first.json");
    if (done && !is_new) return "the old configuration is in force";
    if (is_new && (!has_recipe || !fs::exists(folder_ / "fvd.json.old-1"))) return "what belongs to it is missing";
    return fs::exists(file_) ? "" : "there is no configuration";
  }

 private:
  SetupDraft draft_;
  const fs::path folder_;
  const fs::path file_;
};

class AStack final : public WriteSite {
 public:
  explicit AStack(const fs::path& folder) : file_(folder / "stack.ome.tif") {
    stack_.format = PixelFormat::kMono16;
    stack_.width = slice_.width();
    stack_.height = slice_.height();
    stack_.z_um = {1.0, 2.0, 3.0};
  }
  void work() override {
    write_ome_tiff(file_, stack_, [this](int) { return image_view(slice_.view(), PixelFormat::kMono16); });
  }
  void clear() override { fs::remove(file_); }  // by the user, whom the next attempt tells that it is there
  std::string wrong(bool done) override { return !done && fs::exists(file_) ? "a part is left" : ""; }

 private:
  Plane<std::uint16_t> slice_{64, 48};
  OmeStack stack_;
  const fs::path file_;
};

INSTANTIATE_TEST_SUITE_P(OfOthers, AWriteSite,
                         testing::Values(test::write_site<ARecipe>("Recipe"),
                                         test::write_site<SomeConstants>("Constants"),
                                         test::write_site<AStudy>("Study"), test::write_site<ABackup>("Backup", 5),
                                         test::write_site<ARestoration>("Restoration", 7),
                                         test::write_site<APortFile>("PortFile"), test::write_site<ASetup>("Setup"),
                                         test::write_site<AStack>("Stack")),
                         [](const auto& of) { return std::string(of.param.name); });

}  // namespace
}  // namespace fvd
