#!/usr/bin/env python3
"""The Debian package in a machine of its own: install, start, kill, hang, upgrade, broken file, remove, purge.

package_test.py --build FOLDER [--old-build FOLDER] [--cache FOLDER]
  --build      a build with fvd, fvdctl, fvd-sim and man
  --old-build  the folder "build" in the sources of version 0.4.0, whose programs and configuration are in the package
               that is upgraded; without it the new ones are, and their database is made one of version 10. Its unit is that of 0.4.0 (DynamicUser) either way, and it has nothing that came since
Prints a line for each step, and as its last line one JSON object of what holds. Exit code 77: not possible here, as the
line before says.
"""
import argparse
import json
import os
import pathlib
import re
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import time

from machine import Machine, NotPossible, base_root, run

HERE = pathlib.Path(__file__).resolve().parent
WAIT_S = 60

SIMULATED = {"camera": {"address": "127.0.0.1", "packet_size_bytes": 8000, "packet_socket": False, "simulated": True},
             "stage": {"profile": "drives/oriental-az.json", "address": "127.0.0.1", "port": 1502, "min_um": -500,
                       "max_um": 500, "take_up_um": 20, "simulated": True},
             "rpc": {"address": "127.0.0.1", "port": 7411},
             "paths": {"state_dir": "/var/lib/fvd", "runtime_dir": "/run/fvd", "recipe_dir": "recipes"},
             "compute": {"memory_budget_mib": 600}}


def make_package(build, folder):
    run("cpack", "-G", "DEB", "--config", str(build / "CPackConfig.cmake"), "-B", str(folder))
    return next(folder.glob("fvd_*.deb"))


def make_old_package(new, old_build, folder):
    """As 0.4.0 would have been packaged: the unit of that version, no user."""
    tree = folder / "old"
    run("dpkg-deb", "-R", str(new), str(tree))
    unit = (HERE / "fvd-0.4.0.service.in").read_text(encoding="utf-8")
    if not old_build:  # today's programs lock the drive
        unit = unit.replace("[Service]\n", "[Service]\nReadWritePaths=/run/lock/fvd\n")
    (tree / "usr/lib/systemd/system/fvd.service").write_text(unit.replace("@CMAKE_INSTALL_FULL_SBINDIR@", "/usr/sbin"),
                                                             encoding="utf-8")
    (tree / "usr/lib/sysusers.d/fvd.conf").unlink()
    if old_build:
        (tree / "usr/lib/tmpfiles.d/fvd.conf").unlink()  # today's programs need the folder that it makes
        for program, place in (("daemon/fvd", "sbin/fvd"), ("daemon/ctl/fvdctl", "bin/fvdctl"), ("sim/fvd-sim", "bin/fvd-sim")):
            shutil.copy(old_build / program, tree / "usr" / place)
            run("strip", str(tree / "usr" / place))
        for file in (tree / "etc/fvd").rglob("*.json"):  # what that version cannot read did not come with it
            shutil.copy(old_build.parent / "config" / file.relative_to(tree / "etc/fvd"), file)
    control = (tree / "DEBIAN/control").read_text(encoding="utf-8")
    (tree / "DEBIAN/control").write_text(re.sub(r"(?m)^Version: .*", "Version: 0.4.0~old-1", control), encoding="utf-8")
    postinst = (tree / "DEBIAN/postinst").read_text(encoding="utf-8")
    (tree / "DEBIAN/postinst").write_text(postinst.replace("systemd-sysusers fvd.conf", ":"), encoding="utf-8")
    deb = folder / "fvd_old.deb"
    run("dpkg-deb", "--root-owner-group", "-b", str(tree), str(deb))
    return deb


def depends_of(deb):
    field = run("dpkg-deb", "-f", str(deb), "Depends")
    return [re.split(r"[ (|]", entry.strip())[0] for entry in field.split(",") if entry.strip()]


class Life:
    """The steps, in their order; each proves its claims and notes what holds."""

    def __init__(self, machine, old, new, has_old_programs):
        self.machine, self.old, self.new, self.holds = machine, old, new, {}
        self.has_old_programs = has_old_programs

    # --- questions ---

    def show(self, key):
        return self.machine.run("systemctl", "show", "-P", key, "fvd").strip()

    def state(self):
        code, output = self.machine.try_run("fvdctl", "state")
        return json.loads(output) if code == 0 else {}

    def wait(self, what, holds):
        deadline = time.monotonic() + WAIT_S
        while time.monotonic() < deadline:
            if holds():
                return
            time.sleep(0.1)
        journal = self.machine.try_run("journalctl", "-u", "fvd", "-n", "40", "--no-pager")[1]
        raise AssertionError(f"not within {WAIT_S} s: {what}\n{self.machine.try_run('systemctl', 'status', 'fvd')[1]}\n{journal}")

    def wait_ready(self):
        self.wait("fvd is ready", lambda: self.state().get("ready") is True)

    def journal(self, *more):
        return self.machine.run("journalctl", "-u", "fvd", "--no-pager", "-o", "cat", *more)

    def configure(self, path, document):
        self.machine.shell(f"mkdir -p {os.path.dirname(path)}; cat > {path} <<'END'\n{document}\nEND")

    def dpkg(self, *arguments):
        return self.machine.run("dpkg", "--force-confold", *arguments)

    # --- steps ---

    def install_old(self):
        self.dpkg("-i", "/packages/old.deb")
        self.machine.run("systemctl", "is-enabled", "fvd")
        self.configure("/etc/fvd/fvd.json", json.dumps(SIMULATED))  # an edited conffile
        self.machine.shell("cd /etc/fvd/recipes; sed 's/\"slices\": 21/\"slices\": 7/' chapter.json > mine.json; "
                           "echo '// edited' >> fine.json")
        self.machine.run("systemd-run", "--unit=plant", "fvd-sim", "run")
        self.machine.run("systemctl", "start", "fvd")
        self.wait_ready()
        self.machine.run("fvdctl", "start", "--part", "part-1", "--recipe", "mine", "--watch")

    def make_database_older(self):
        """As 0.5.0 left it (version 10), where today's programs stood in for those of the old package."""
        self.machine.run("systemctl", "stop", "fvd")
        found = [path for path in (self.machine.root / "var/lib/private/fvd", self.machine.root / "var/lib/fvd")
                 if (path / "fvd.sqlite").exists()]
        assert found, "no database"
        database = sqlite3.connect(found[0] / "fvd.sqlite")
        database.execute("DROP TRIGGER job_values_go_with_their_job")
        for index in ("jobs_with_results", "jobs_with_removed_results", "jobs_history"):
            database.execute(f"DROP INDEX {index}")
        for column in ("session", "verdict", "reason_codes", "removed_utc"):
            database.execute(f"ALTER TABLE jobs DROP COLUMN {column}")
        for table in ("job_values", "audit", "seq_floors", "prepared_recipe"):
            database.execute(f"DROP TABLE {table}")
        database.execute("PRAGMA user_version = 10")
        database.commit()
        database.close()
        for name in ("fvd.epoch", "fvd.sqlite-shm", "fvd.sqlite-wal"):
            (found[0] / name).unlink(missing_ok=True)

    def upgrade(self):
        before = self.state()
        if not self.has_old_programs:
            self.make_database_older()
        self.dpkg("-i", "/packages/new.deb")
        if not self.has_old_programs:  # it was stopped for its database, and an upgrade starts nothing that was stopped
            self.machine.run("systemctl", "start", "fvd")
        self.wait("the new daemon is ready", lambda: self.state().get("epoch", 0) > before["epoch"] and self.state()["ready"])
        assert self.show("User") == "fvd"
        if not self.has_old_programs:
            assert (self.machine.root / "var/lib/fvd/fvd.sqlite.v10").exists(), "no copy was kept before the upgrade"
        latest = json.loads(self.machine.run("fvdctl", "rpc", "job.latest", '{"client": "fvdctl"}'))
        assert latest["seq"] >= 1, latest
        result = json.loads(self.machine.run("fvdctl", "result", "--format", "full"))
        assert result["state"] == "completed" and result["part_id"] == "part-1", result
        recipes = self.machine.run("fvdctl", "rpc", "recipe.list")
        assert '"mine"' in recipes, recipes
        assert "127.0.0.1" in self.machine.run("cat", "/etc/fvd/fvd.json")
        assert "// edited" in self.machine.run("cat", "/etc/fvd/recipes/fine.json")
        # Its group reads what it stored, nobody else does.
        self.machine.shell("useradd -G fvd anna; useradd bert")
        file = result["directory"] + "/result.json"
        self.machine.run("runuser", "-u", "anna", "--", "cat", file)
        assert self.machine.try_run("runuser", "-u", "bert", "--", "cat", file)[0] != 0
        self.machine.run("fvdctl", "start", "--part", "part-2", "--recipe", "mine", "--watch")
        result = json.loads(self.machine.run("fvdctl", "result", "--format", "full"))
        self.machine.run("runuser", "-u", "anna", "--", "cat", result["directory"] + "/result.json")
        assert "completed" in self.journal("FVD_PART_ID=part-2")
        self.holds["upgraded"] = True

    def kill(self):
        pid = self.show("MainPID")
        self.machine.run("systemctl", "kill", "--signal=KILL", "--kill-whom=main", "fvd")
        self.wait("another process", lambda: self.show("MainPID") not in (pid, "0"))
        self.wait_ready()
        self.wait("the axis was stopped", lambda: "the stage stands still at" in self.journal())
        self.holds["killed_and_back"] = True

    def hang(self):
        pid = self.show("MainPID")
        self.machine.run("systemctl", "kill", "--signal=STOP", "--kill-whom=main", "fvd")
        self.wait("the watchdog ends it", lambda: self.show("MainPID") not in (pid, "0"))
        self.wait_ready()
        self.holds["hung_and_back"] = True

    def reload(self):
        pid = self.show("MainPID")
        self.configure("/etc/fvd/conf.d/50-log.json", '{"log": {"level": "debug"}}')
        self.machine.run("systemctl", "reload", "fvd")
        self.wait("the level is taken", lambda: "reloaded /log/level: info -> debug" in self.journal())
        assert self.show("MainPID") == pid
        self.holds["reloaded"] = True

    def take_port(self):
        self.machine.run("systemctl", "stop", "fvd")
        rpc = {"address": "192.0.2.7", "allow": [{"address": "192.0.2.0/24", "role": "operate"}]}
        self.configure("/etc/fvd/conf.d/60-late.json", json.dumps({"rpc": rpc}))
        self.machine.run("systemctl", "start", "--no-block", "fvd")
        self.wait("it waits", lambda: "no network card has this address" in self.show("StatusText"))
        pid = self.show("MainPID")
        self.machine.run("ip", "address", "add", "192.0.2.7/32", "dev", "lo")
        self.wait("it is active", lambda: self.show("ActiveState") == "active")
        assert self.show("MainPID") == pid
        self.machine.shell("rm -f /etc/fvd/conf.d/60-late.json; systemctl restart fvd")
        self.wait_ready()
        self.holds["waits_for_address"] = True

    def break_file(self):
        self.configure("/etc/fvd/conf.d/99-broken.json", "{")
        self.machine.try_run("systemctl", "restart", "fvd")
        self.wait("it has failed", lambda: self.show("ActiveState") == "failed")
        assert self.show("ExecMainStatus") == "78", self.show("ExecMainStatus")
        restarts = self.show("NRestarts")
        time.sleep(3)  # three times as long as it would take to start it again
        assert self.show("ActiveState") == "failed" and self.show("NRestarts") == restarts
        assert "99-broken.json" in self.journal()
        assert self.machine.try_run("fvd", "--check-config")[0] == 78
        self.machine.run("rm", "/etc/fvd/conf.d/99-broken.json")
        self.machine.run("fvd", "--check-config")
        self.machine.run("systemctl", "start", "fvd")
        self.wait_ready()
        self.holds["broken_file_stops"] = True

    def remove(self):
        self.dpkg("-r", "fvd")
        assert self.machine.try_run("test", "-e", "/usr/sbin/fvd")[0] != 0
        assert self.machine.try_run("systemctl", "is-active", "fvd")[0] != 0
        self.machine.run("test", "-e", "/etc/fvd/fvd.json")
        self.holds["removed"] = True

    def purge(self):
        self.machine.shell("rm -rf /var/lib/fvd/results/* && mkdir -p /var/lib/fvd/calibration && "
                           "echo '{\"format\": 1, \"versions\": []}' > /var/lib/fvd/calibration/calibration.json")
        said = self.dpkg("-P", "fvd")
        assert self.machine.try_run("test", "-e", "/etc/fvd/fvd.json")[0] != 0
        assert "stay in /var/lib/fvd" in said, said
        for kept in ("calibration/calibration.json", "fvd.sqlite"):
            self.machine.run("test", "-e", f"/var/lib/fvd/{kept}")
        assert self.machine.try_run("systemctl", "cat", "fvd")[0] != 0
        self.holds["purged"] = True

    def install_new(self):
        self.dpkg("-i", "/packages/new.deb")
        assert self.machine.run("systemctl", "is-enabled", "fvd").strip() == "enabled"
        assert self.show("ActiveState") == "inactive", "nothing is moved before a person has said what there is"
        assert self.machine.run("getent", "group", "fvd-view")
        self.machine.run("fvd", "--check-config")
        self.configure("/etc/fvd/conf.d/10-station.json", json.dumps(SIMULATED))
        self.machine.run("systemctl", "start", "fvd")
        self.wait_ready()
        self.holds["installed"] = self.holds["ready"] = True


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", required=True, type=pathlib.Path)
    parser.add_argument("--old-build", type=pathlib.Path)
    parser.add_argument("--cache", default=os.environ.get("FVD_MACHINE_CACHE", "/var/cache/fvd-tests"))
    options = parser.parse_args()
    work = pathlib.Path(tempfile.mkdtemp(prefix="fvd-package-"))
    machine = None
    try:
        for program in ("cpack", "dpkg-deb", "systemd-nspawn", "debootstrap", "nsenter"):
            if not shutil.which(program):
                raise NotPossible(f"{program} is not installed")
        if os.geteuid() != 0:
            raise NotPossible("only root may boot a machine")
        new = make_package(options.build.resolve(), work)
        if shutil.which("lintian"):
            said = subprocess.run(["lintian", "--allow-root", "--fail-on", "error", str(new)], text=True,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
            print(said.stdout, end="")
            assert said.returncode == 0, "lintian finds errors"
        old = make_old_package(new, options.old_build, work)
        base = base_root(options.cache, [*depends_of(new), "iproute2"])
        machine = Machine(base)
        (machine.root / "packages").mkdir()
        shutil.copy(old, machine.root / "packages/old.deb")
        shutil.copy(new, machine.root / "packages/new.deb")
        machine.boot()
        life = Life(machine, old, new, options.old_build is not None)
        for step in (life.install_old, life.upgrade, life.kill, life.hang, life.reload, life.take_port, life.break_file,
                     life.remove, life.purge, life.install_new):
            begun = time.monotonic()
            try:
                step()
            except (AssertionError, RuntimeError, KeyError, ValueError):
                print(f"FAILED: {step.__name__}; the journal ends with:")
                print(machine.try_run("journalctl", "-u", "fvd", "-n", "40", "--no-pager")[1])
                raise
            print(f"{step.__name__}: {time.monotonic() - begun:.1f} s", flush=True)
        print(json.dumps(life.holds))
        return 0
    except NotPossible as reason:
        print(f"skipped, no machine can be booted here: {reason}")
        return 77
    finally:
        if machine:
            machine.close()
        shutil.rmtree(work, ignore_errors=True)


if __name__ == "__main__":
    sys.exit(main())
