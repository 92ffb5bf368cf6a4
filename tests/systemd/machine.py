"""A Debian machine booted in a container, from a root folder that is made once and kept outside of the sources."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import time

BASE_PACKAGES = "systemd,systemd-sysv,dbus,udev"
BOOT_S = 120


class NotPossible(Exception):
    """Why no machine can be booted here: no failure of what is tested."""


def run(*command, **options):
    """Runs it and returns what it printed; an exception with all of that if it fails."""
    done = subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False, **options)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, command))}: {done.returncode}\n{done.stdout}")
    return done.stdout


def base_root(cache, depends):
    """The folder with a minimal system and the packages `depends`; made if it is not there."""
    root = pathlib.Path(cache) / "bookworm"
    if not (root / "usr/bin/systemctl").exists():
        pathlib.Path(cache).mkdir(parents=True, exist_ok=True)
        try:
            run("debootstrap", "--variant=minbase", f"--include={BASE_PACKAGES}", "bookworm", str(root))
        except RuntimeError as error:
            shutil.rmtree(root, ignore_errors=True)
            raise NotPossible(f"debootstrap failed: {str(error)[-300:]}") from error
    query = subprocess.run(["chroot", str(root), "dpkg-query", "-W", "-f", "${Package} ${db:Status-Status}\n"],
                           text=True, capture_output=True, check=True).stdout
    missing = [name for name in depends if f"{name} installed" not in query.splitlines()]
    if missing:
        shutil.copy("/etc/resolv.conf", root / "etc/resolv.conf")
        for proxy in ("/etc/apt/apt.conf", "/etc/apt/apt.conf.d"):  # how this machine reaches its archive
            if os.path.isdir(proxy):
                for part in pathlib.Path(proxy).iterdir():
                    if "roxy" in part.read_text(errors="replace"):
                        shutil.copy(part, root / proxy.lstrip("/"))
        try:
            run("chroot", str(root), "apt-get", "update", "-qq")
            run("chroot", str(root), "env", "DEBIAN_FRONTEND=noninteractive", "apt-get", "install", "-y", "-qq",
                "--no-install-recommends", *missing)
        except RuntimeError as error:
            raise NotPossible(f"packages could not be fetched: {str(error)[-300:]}") from error
    return root


class Machine:
    """Booted in the constructor from a copy of `base`, which it leaves as it is; gone after close()."""

    def __init__(self, base):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="fvd-machine-"))
        self.root = self.folder / "root"
        self.mounted = self._mount(base)
        self.log = open(self.folder / "console.log", "w+", encoding="utf-8", errors="replace")
        self.process = None
        self.leader = None

    def _mount(self, base):
        self.root.mkdir()
        for name in ("upper", "work"):
            (self.folder / name).mkdir()
        overlay = f"lowerdir={base},upperdir={self.folder}/upper,workdir={self.folder}/work"
        if subprocess.run(["mount", "-t", "overlay", "overlay", "-o", overlay, str(self.root)], capture_output=True,
                          check=False).returncode == 0:
            return True
        self.root.rmdir()
        run("cp", "-a", "--reflink=auto", str(base), str(self.root))
        return False

    def boot(self):
        command = ["systemd-nspawn", "-q", "-D", str(self.root), "--boot", "--register=no", "--keep-unit",
                   "--private-network", "--console=pipe"]
        self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=self.log, stderr=self.log)
        deadline = time.monotonic() + BOOT_S
        while time.monotonic() < deadline:
            if self.process.poll() is not None:
                raise NotPossible(f"systemd-nspawn ended: {self.console()[-300:]}")
            children = pathlib.Path(f"/proc/{self.process.pid}/task/{self.process.pid}/children").read_text().split()
            for child in children:
                if pathlib.Path(f"/proc/{child}/comm").read_text().strip() == "systemd":
                    self.leader = child
            if self.leader and self.try_run("systemctl", "is-system-running")[1].strip() in ("running", "degraded"):
                return
            time.sleep(0.1)
        raise NotPossible(f"the machine did not boot: {self.console()[-300:]}")

    def console(self):
        self.log.flush()
        return (self.folder / "console.log").read_text(errors="replace")

    def try_run(self, *command):
        """(exit code, output) of a command inside."""
        done = subprocess.run(["nsenter", "-t", self.leader, "-m", "-u", "-i", "-n", "-p", "-C", "--", "env", "-i",
                               "PATH=/usr/sbin:/usr/bin:/sbin:/bin", "DEBIAN_FRONTEND=noninteractive", "LC_ALL=C.UTF-8",
                               *command],
                              text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              errors="replace", check=False)
        return done.returncode, done.stdout

    def run(self, *command):
        code, output = self.try_run(*command)
        if code != 0:
            raise RuntimeError(f"in the machine: {' '.join(command)}: {code}\n{output}")
        return output

    def shell(self, script):
        return self.run("sh", "-ec", script)

    def close(self):
        if self.process and self.process.poll() is None:
            self.process.terminate()  # powers it off
            try:
                self.process.wait(60)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()
        self.log.close()
        if self.mounted:
            subprocess.run(["umount", str(self.root)], check=False)
        shutil.rmtree(self.folder, ignore_errors=True)
