"""Simulated faults: a driver that fails (faulty_driver.c), a full disk and a wrong clock (faulty_system.c), and a thread
that is stopped."""
import ctypes
import json
import os
import struct
import time

SEIZE, INTERRUPT, DETACH = 0x4206, 0x4207, 17  # of ptrace
ALL_CHILDREN = 0x40000000  # __WALL of waitpid: threads, too


class FaultyDriver:
    """A driver that works like Mesa's until `strike()`. A program started with `environment` uses it."""

    def __init__(self, folder, library, fault):
        self._when = os.path.join(folder, "strike")
        vendor = os.path.join(folder, "faulty.json")
        with open(vendor, "w", encoding="utf-8") as file:
            json.dump({"file_format_version": "1.0.0", "ICD": {"library_path": library}}, file)
        self.environment = {**os.environ, "__EGL_VENDOR_LIBRARY_FILENAMES": vendor, "SPHERULE_FAULT": fault,
                            "SPHERULE_FAULT_WHEN": self._when}

    def strike(self):
        with open(self._when, "w", encoding="utf-8"):
            pass

    def heal(self):
        """Programs that start from now on find a good driver, until the next strike."""
        os.remove(self._when)


class FaultySystem:
    """An operating system with a wrong wall clock or a full disk, for programs started with `environment`."""

    def __init__(self, folder, library):
        self._path = os.path.join(folder, "faulty-system")
        self._clock, self._full = 0, False
        self._apply()
        self.environment = {**os.environ, "LD_PRELOAD": library, "SPHERULE_FAULTY_SYSTEM": self._path}

    def set_clock(self, seconds):
        """The wall clock jumps to this offset from the right time."""
        self._clock = seconds
        self._apply()

    def fill_disk(self, full):
        """From now on, writes to files fail, or no longer fail."""
        self._full = full
        self._apply()

    def _apply(self):
        with open(self._path, "r+b" if os.path.exists(self._path) else "wb") as file:
            file.write(struct.pack("=qq", self._clock, self._full))


class HeldThread:
    """Stops one thread of a child process within a with statement.

    `others_run` returns whether the other threads still work. They do not if the stopped thread holds a lock. It is
    then resumed, and stopped again at another moment."""

    def __init__(self, pid, name, others_run):
        self._others_run = others_run
        self._id = min(int(task) for task in os.listdir(f"/proc/{pid}/task")
                       if _read(f"/proc/{pid}/task/{task}/comm").strip() == name)
        self._held = False

    def __enter__(self):
        for _ in range(20):
            self._hold()
            try:
                if self._others_run():
                    return self
            except BaseException:
                self.release()
                raise
            self.release()
            time.sleep(0.01)
        raise AssertionError("the process does not work without this thread")

    def _hold(self):
        _ptrace(SEIZE, self._id)
        _ptrace(INTERRUPT, self._id)
        os.waitpid(self._id, ALL_CHILDREN)
        self._held = True

    def release(self):
        if self._held:
            self._held = False
            try:
                _ptrace(DETACH, self._id)
            except ProcessLookupError:  # the process has ended, and is a zombie
                os.waitpid(self._id, ALL_CHILDREN)

    def wait_for_the_end(self, patience):
        """Waits for the end of the process (`patience`: s), without resuming the thread."""
        end = time.monotonic() + patience
        while os.waitpid(self._id, ALL_CHILDREN | os.WNOHANG)[0] == 0:
            if time.monotonic() > end:
                raise AssertionError(f"the process has not ended within {patience} s")
            time.sleep(0.02)
        self._held = False

    def __exit__(self, *_):
        self.release()


def _read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def _ptrace(request, thread):
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.ptrace(request, thread, None, None) != 0:
        error = ctypes.get_errno()
        raise OSError(error, os.strerror(error))
