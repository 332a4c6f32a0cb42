"""A bare Debian in a folder, to which programs change their root. Needs root."""
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

MAKE_BASE = Path(__file__).resolve().parents[2] / "image/make_base.sh"


# Variables of programs that fetch packages. tests/run.sh sets PACKAGE_PROXY.
PROXY = {name: proxy for name in ("http_proxy", "https_proxy") if (proxy := os.environ.get("PACKAGE_PROXY"))}


def obstacle():
    return "" if os.geteuid() == 0 else "only root can change to another root"


def make_base(tar):
    """Makes the tar file of the bare Debian if it is missing."""
    if not tar.exists():
        tar.parent.mkdir(parents=True, exist_ok=True)
        subprocess.run([MAKE_BASE, tar], check=True, env=os.environ | PROXY)


class DebianRoot:
    """Has the files of `base`, a tar file of make_base() or the path of another root. `path` is its folder."""

    def __init__(self, base):
        self.path = Path(tempfile.mkdtemp(prefix="debian-root-"))
        self.path.chmod(0o755)
        if base.is_dir():
            subprocess.run(["cp", "-a", "--one-file-system", f"{base}/.", self.path], check=True)
        else:
            subprocess.run(["tar", "-xf", base, "-C", self.path], check=True)
        for name in ("resolv.conf", "hosts"):
            shutil.copy(f"/etc/{name}", self.path / "etc")

    def close(self):
        subprocess.run(["rm", "-rf", "--one-file-system", self.path], check=True)

    def call(self, *command):
        """Runs the command in the root, with /proc and without the variables of the caller."""
        inside = ["unshare", "--mount", "sh", "-c", 'mount -t proc proc "$0/proc" && exec chroot "$0" "$@"', self.path]
        return subprocess.run([*inside, *command], capture_output=True, text=True, check=False, errors="replace",
                              env=PROXY | {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/root",
                                               "DEBIAN_FRONTEND": "noninteractive"})

    def install(self, *packages):
        """Installs Debian packages, or files of packages, without the packages that they recommend."""
        for command in (("apt-get", "update"), ("apt-get", "install", "-y", "--no-install-recommends", *packages)):
            done = self.call(*command)
            assert done.returncode == 0, done.stdout + done.stderr
