"""Makes and changes Debian packages for tests."""
import os
import re
import subprocess
from pathlib import Path


def make(build, folder, **variables):
    """Packs the program of the build folder as deploy/package.sh does. Returns the path of the package. `variables`:
    further variables of the environment."""
    done = subprocess.run(["cpack", "-G", "DEB", "--config", Path(build) / "CPackConfig.cmake", "-B", folder],
                          capture_output=True, text=True, check=False, umask=0o022, env={**os.environ, **variables})
    assert done.returncode == 0, done.stdout + done.stderr
    (package,) = Path(folder).glob("*.deb")
    return package


def field(package, name):
    return subprocess.run(["dpkg-deb", "--field", package, name], capture_output=True, text=True, check=True).stdout.strip()


def unpack(package, folder):
    subprocess.run(["dpkg-deb", "--extract", package, folder], check=True)


def next_version(package, folder, settings):
    """Makes the same package with a higher version and other settings. Returns its path."""
    subprocess.run(["dpkg-deb", "--raw-extract", package, folder], check=True)
    control = Path(folder) / "DEBIAN/control"
    text, count = re.subn(r"^(Version: .*)", r"\1+next", control.read_text(encoding="utf-8"), flags=re.MULTILINE)
    assert count == 1
    control.write_text(text, encoding="utf-8")
    path = Path(folder) / "etc/spherule/serve.toml"
    path.write_text(settings(path.read_text(encoding="utf-8")), encoding="utf-8")
    made = Path(f"{folder}.deb")
    subprocess.run(["dpkg-deb", "--build", "--root-owner-group", folder, made], check=True, capture_output=True)
    return made
