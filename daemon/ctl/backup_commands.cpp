#include "daemon/ctl/backup_commands.hpp"

#include <algorithm>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <sys/stat.h>

#include "core/base/error.hpp"
#include "daemon/backup/backup.hpp"
#include "daemon/backup/restore.hpp"
#include "daemon/config/config_file.hpp"
#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/process_command.hpp"
#include "daemon/store/store_marker.hpp"

namespace fvd::ctl {

namespace {

namespace fs = std::filesystem;

/// As the configuration says; what of it is not there yet is taken from `instead`, as a restoration puts it back.
InstrumentPaths paths_of(const fs::path& config, const fs::path& instead) {
  std::error_code error;
  const fs::path base = fs::absolute(config).parent_path();
  const fs::path parts = base / "conf.d";
  const bool has_parts = fs::is_directory(parts, error) && !fs::is_empty(parts, error) && !is_half_restored(parts);
  const fs::path& source = fs::exists(config, error) || instead.empty() ? config : instead / "fvd.json";
  if (!fs::exists(source, error)) {
    throw Error(ErrorCode::kBadConfig,
                "there is no " + source.string() + ": name the daemon's configuration by --config");
  }
  const LoadedConfig loaded = merge_config(source, has_parts || instead.empty() ? parts : instead / "conf.d", base);
  throw_if_any(loaded.problems, ErrorCode::kBadConfig, source.string());
  const Config& read = loaded.config;
  return {.state_dir = read.paths.state_dir,
          .recipe_dir = read.paths.recipe_dir,
          .config_file = base / config.filename(),
          .stage_profile = read.stage.profile,
          .token_file = read.rpc.access.token_file};
}

bool on_one_disk(const fs::path& one, const fs::path& other) {
  struct stat of_one {};
  struct stat of_other {};
  return ::stat(one.c_str(), &of_one) == 0 && ::stat(other.c_str(), &of_other) == 0 && of_one.st_dev == of_other.st_dev;
}

int backup(const BackupArguments& arguments, const Terminal& terminal) {
  const InstrumentPaths instrument = paths_of(arguments.config, {});
  const auto missing = make_backup(instrument, arguments.folder, arguments.results);
  if (on_one_disk(arguments.folder, instrument.state_dir)) {
    terminal.err << "fvdctl: warning: " << arguments.folder
                 << " is on the disk of the state folder, and is lost with it; is the disk for backups not mounted?"
                 << std::endl;
  }
  terminal.out << arguments.folder << " holds a backup" << (arguments.results ? " with results" : "") << std::endl;
  for (const std::string& name : missing) {
    terminal.err << "fvdctl: result " << name << " is known to the database, but its folder is not there" << std::endl;
  }
  return kExitOk;
}

/// The newer results, which have no job any more.
void tell_unknown(const std::vector<std::string>& names, const Terminal& terminal) {
  constexpr std::size_t kNamed = 10;
  if (names.empty()) return;
  terminal.out << names.size()
               << " results or evaluations are not known to the backup; no call gives them, and the next start leaves "
                  "their folders where they are:\n";
  for (std::size_t i = 0; i < std::min(names.size(), kNamed); ++i) terminal.out << "  " << names[i] << "\n";
  if (names.size() > kNamed) terminal.out << "  and " << names.size() - kNamed << " more\n";
}

/// Without a configuration of its own the target is the one of the backup, and that may be an instrument in use: a
/// name that was mistyped must not replace what it knows.
void require_meant_target(const fs::path& config, const fs::path& folder, const fs::path& state_dir) {
  std::error_code error;
  if (fs::exists(config, error) || !fs::exists(state_dir / "fvd.sqlite", error)) return;
  throw Error(ErrorCode::kBadConfig,
              "there is no " + config.string() + ", and the configuration of the backup names the state folder " +
                  state_dir.string() +
                  ", which holds a database: nothing was restored. To replace what is there, copy " +
                  (folder / "fvd.json").string() + " to " + config.string() +
                  " first, and the backup's conf.d beside it if it has one; to restore elsewhere, write a "
                  "configuration with another paths.state_dir there");
}

int restore(const BackupArguments& arguments, const Terminal& terminal) {
  const fs::path folder = arguments.folder;
  const InstrumentPaths target = paths_of(arguments.config, folder);
  std::error_code error;
  terminal.out << "target: state folder " << target.state_dir.string() << ", configuration "
               << target.config_file.string()
               << (fs::exists(target.config_file, error) ? "" : ", which is not there: the backup's is put there")
               << "\n"
               << std::flush;
  require_meant_target(target.config_file, folder, target.state_dir);
  const Restored restored = restore_backup(folder, target);
  terminal.out << "restored; the next epoch is " << restored.epoch + 1 << ", " << restored.results
               << " results were added\n";
  if (!restored.replaced.empty()) terminal.out << "what was there before is in " << restored.replaced.string() << "\n";
  for (const fs::path& dropped : restored.dropped) {
    terminal.out << dropped.string()
                 << ", which an earlier restoration replaced, is removed: the newest two are kept\n";
  }
  for (const std::string& kept : restored.kept) {
    terminal.out << kept << " is there and stays as it is; the backup's is in " << folder.string() << "\n";
  }
  tell_unknown(restored.unknown, terminal);
  terminal.out << (restored.margin == 0 ? "sequence numbers that were used since the backup stay used"
                                        : unknown_numbers_text(restored.margin))
               << "\n"
               << std::flush;
  return kExitOk;
}

/// Another instrument than the one that was meant must not be copied, or overwritten.
void require_no_daemon_named(const CLI::App& app, const std::string& command) {
  for (const char* option : {"--address", "--runtime-dir"}) {
    if (app.count(option) == 0) continue;
    throw UsageError(command + " asks no daemon, so that " + option +
                     " says nothing of whose data is meant: name the daemon's configuration by --config");
  }
}

}  // namespace

void add_backup_commands(CLI::App& app, BackupArguments& a, const Terminal& terminal, std::function<int()>& chosen) {
  const auto add = [&](const char* name, const char* help, const char* folder, auto run) {
    CLI::App* sub = app.add_subcommand(name, help);
    sub->add_option("folder", a.folder, folder)->required();
    sub->add_option("--config", a.config, "the daemon's configuration")->capture_default_str()->type_name("FILE");
    sub->callback([&app, &a, &chosen, terminal, run, name] {
      chosen = [&app, &a, terminal, run, name] {
        require_no_daemon_named(app, name);
        return run(a, terminal);
      };
    });
    return sub;
  };
  add("backup", "copy all that the instrument knows, also while it measures", "to be made; must not exist", backup)
      ->add_flag("--results", a.results, "with the folders of all results");
  add("restore", "put a backup back; the daemon must not run", "that `backup` made", restore);
}

}  // namespace fvd::ctl
