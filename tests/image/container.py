"""A container of the image, run by crun with the settings of Kubernetes. It has the image's user, no capabilities, no
new privileges, the usual filter of system calls, and a read-only root. Unlike on a Kubernetes node, there are no control
groups. The container shares the network of the caller, which has its own network namespace."""
import json
import os
import platform
import signal
import subprocess
import tempfile
import uuid

PROFILE = "/usr/share/containers/seccomp.json"  # the default of Docker and Podman, and RuntimeDefault of Kubernetes
ARCHITECTURES = {"x86_64": "amd64", "aarch64": "arm64"}


def system_calls():
    """Returns the profile of system calls in OCI's format, for a container without capabilities."""
    with open(PROFILE, encoding="utf-8") as file:
        profile = json.load(file)
    here = ARCHITECTURES[platform.machine()]
    rules = []
    for rule in profile["syscalls"]:
        includes = rule.get("includes") or {}
        if "caps" in includes or here not in includes.get("arches", [here]):
            continue
        rules.append({key: rule[key] for key in ("names", "action", "args", "errnoRet") if rule.get(key)})
    return {"defaultAction": profile["defaultAction"], "defaultErrnoRet": profile["defaultErrnoRet"], "syscalls": rules}


def mount(destination, kind, *options):
    return {"destination": destination, "type": kind, "source": kind, "options": list(options)}


class Container:
    """A container with `data` at /data. It may only write there and in /tmp."""

    def __init__(self, config, root, data, arguments=None, settings=None):
        self._config, self._root, self._data = config, str(root), data
        self._arguments = config["Cmd"] if arguments is None else arguments
        self._environment = config["Env"] + [f"{name}={value}" for name, value in (settings or {}).items()]

    def _bundle(self):
        uid, gid = (int(number) for number in self._config["User"].split(":"))
        return {
            "ociVersion": "1.0.2",
            "process": {
                "args": self._config["Entrypoint"] + self._arguments,
                "env": self._environment,
                "cwd": self._config["WorkingDir"],
                "user": {"uid": uid, "gid": gid},
                "noNewPrivileges": True,
                "capabilities": {},
            },
            "root": {"path": self._root, "readonly": True},
            "mounts": [
                mount("/proc", "proc"),
                mount("/dev", "tmpfs", "nosuid", "mode=755", "size=64k"),
                mount("/dev/shm", "tmpfs", "nosuid", "noexec", "nodev", "mode=1777", "size=64m"),
                mount("/tmp", "tmpfs", "nosuid", "nodev", "mode=1777", "size=64m"),
                {"destination": "/data", "type": "bind", "source": self._data, "options": ["rbind", "nosuid", "nodev"]},
            ],
            "linux": {
                "namespaces": [{"type": kind} for kind in ("pid", "ipc", "uts", "mount")],
                "maskedPaths": ["/proc/kcore", "/proc/keys", "/proc/timer_list", "/sys/firmware"],
                "readonlyPaths": ["/proc/bus", "/proc/fs", "/proc/irq", "/proc/sys", "/proc/sysrq-trigger"],
                "seccomp": system_calls(),
            },
        }

    def _crun(self, *words):
        return ["crun", "--root", self._folder.name + "/state", "--cgroup-manager=disabled", *words]

    def start(self):
        self._folder = tempfile.TemporaryDirectory(prefix="spherule-image-")
        self._name = "spherule-" + uuid.uuid4().hex
        with open(self._folder.name + "/config.json", "w", encoding="utf-8") as file:
            json.dump(self._bundle(), file)
        self._said = open(self._folder.name + "/said", "w+", encoding="utf-8")
        self._process = subprocess.Popen(self._crun("run", "--bundle", self._folder.name, self._name),
                                         stdin=subprocess.DEVNULL, stdout=self._said, stderr=subprocess.STDOUT)
        return self

    def remove(self):
        if self.code() is None:
            self.signal(signal.SIGKILL)
            self.wait()
        self._said.close()
        self._folder.cleanup()

    def signal(self, number):
        subprocess.run(self._crun("kill", self._name, str(int(number))), check=True)

    def execute(self, *command):
        """Runs another process in the container, as `docker exec` and health checks do."""
        return subprocess.run(self._crun("exec", self._name, *command), capture_output=True, text=True, timeout=60,
                              check=False)

    def code(self):
        """Returns the exit code; None while the container runs."""
        return self._process.poll()

    def wait(self, seconds=60):
        return self._process.wait(seconds)

    def said(self):
        self._said.flush()
        with open(self._said.name, encoding="utf-8") as file:
            return file.read()


def without_control_groups():
    """Hides the control groups, in the caller's mount namespace. crun reads them even if it is configured not to use
    them, and fails if there are two versions."""
    subprocess.run(["mount", "-t", "tmpfs", "tmpfs", "/sys/fs/cgroup"], check=True)
    os.makedirs("/run/crun", exist_ok=True)
