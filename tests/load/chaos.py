"""A server under a supervisor, healthy clients, and the disturbances of run_chaos.py and chaos_test.py.

`World` starts the server, starts it again after an end, and keeps the folder of its files. Each disturbance is a method. It
adds the faults that it finds to `faults`, and returns figures for a table.
"""
import asyncio
import glob
import json
import os
import random
import signal
import threading
import time

import attackers
import watched
from faults import FaultyDriver, FaultySystem
from program import runner, wait_for
from serving import Server
from viewer import Controller, Viewer

TOKENS = {"viewer": "the-viewers-token-in-chaos", "controller": "the-controllers-token-in-chaos"}
STEPS_PER_SECOND = 60
PATIENCE = 60  # s for anything that the server does soon


class Steering(threading.Thread):
    """A healthy controller. It sends a command every 0.2 s, and connects again when the server has ended."""

    def __init__(self, connect):
        super().__init__(daemon=True)
        self._connect, self._chance, self._stopped = connect, random.Random(1), threading.Event()
        self._sending, self._controller = threading.Lock(), None
        self.sends = True
        self.sent, self.answers, self.warnings = 0, {}, []  # of connections that have ended

    def run(self):
        while not self._stopped.wait(0.2):
            try:
                with self._sending:
                    if self._controller is None:
                        self._controller = self._connect()
                    if self.sends:
                        self._controller.command(self._chance, without=("model", "checkpoint", "friction"))
            except OSError:
                pass
            if self._controller and not self._connected():
                self._leave()
        if self._controller:
            self._leave()

    def _leave(self):
        with self._sending:
            controller, self._controller = self._controller, None
        self.sent += controller.sent
        for result in controller.of("result"):
            answer = "applied" if "applied" in result else result["refused"].get("cause", "refused")
            self.answers[answer] = self.answers.get(answer, 0) + 1
        self.warnings += self._warnings(controller)

    @staticmethod
    def _warnings(controller):
        return [event["text"] for event in controller.of("event") if event["kind"] == "WARNING"]

    def ask(self, command):
        """Sends this command when the controller is connected, and returns its result."""
        if not wait_for(self._connected, PATIENCE):
            raise AssertionError("the controller is not connected")
        with self._sending:
            controller = self._controller
            number = controller.send(command)
        return controller.result(number)

    def _connected(self):
        now = self._controller
        return now is not None and now.status == 101 and now.closed is None

    def warned(self, text):
        """The controller has had a warning with this text."""
        now = self._controller
        return any(text in warning for warning in self.warnings + (self._warnings(now) if now else []))

    def stop(self):
        self._stopped.set()
        self.join()


class World:
    def __init__(self, build, folder, scene="box-4k", viewers=20, rate=20, every=5):
        """`viewers`, `rate`: number of healthy viewers under attack, and their frames per second. `every`: s between two
        checkpoints."""
        self.build, self.viewers, self.rate, self.every = build, viewers, rate, every
        self.faults, self.lives = [], []
        self._folder, self._scene, self._logs, self._port = folder, scene, 1, 0
        os.environ["MESA_SHADER_CACHE_DIR"] = folder  # see device_test.py
        libraries = os.path.abspath(os.path.join(build, "tests/faults"))
        self._system = FaultySystem(folder, os.path.join(libraries, "libfaulty_system.so"))
        self._driver = FaultyDriver(folder, os.path.join(libraries, "libfaulty_driver.so"), "reset")
        self._program = os.path.join(build, "spherule")
        self.start()
        self.steering = Steering(lambda: Controller(self._port, rate=0, token=TOKENS["controller"]))
        self.steering.start()
        # A server that was killed before its first checkpoint begins with the scene, and with another log.
        self.grows("spherule_checkpoints_total", 1, "at the beginning")

    def check(self, right, fault):
        if not right:
            self.faults.append(fault)

    def start(self, device="cpu:1", expected=0):
        """Starts the server, which goes on from its checkpoint. `expected`: exit code with which the last one ended."""
        at = lambda name: os.path.join(self._folder, name)  # noqa: E731
        environment = {**self._driver.environment, **self._system.environment, "SPHERULE_VIEWER_TOKEN": TOKENS["viewer"],
                       "SPHERULE_CONTROLLER_TOKEN": TOKENS["controller"]}
        if device != "software":  # the CPU needs no driver
            del environment["__EGL_VENDOR_LIBRARY_FILENAMES"]
        if self.lives:
            self._ended(expected)
        self.server = Server(
            self._program, "serve", self._scene, "--no-sleep", "--device", device, "--checkpoints", at("kept"),
            "--checkpoint-every", f"{self.every}s", "--resume", "--log", at(f"commands-{self._logs}.sphl"), "--record",
            at(f"life-{len(self.lives)}.sph"), "--record-rate", "5", "--recordings", at("recordings"), token=TOKENS["viewer"],
            port=self._port, env=environment)
        self.server.__enter__()
        self._port = self.server.port
        self.lives.append({"server": self.server})

    def _ended(self, expected):
        life = self.lives[-1]
        life["code"] = self.server.wait()
        self.check(life["code"] == expected, f"life {len(self.lives)} ended with {life['code']}, not {expected}: "
                                             f"{self.server.said[-500:]}")

    def stop(self):
        """Stops the server in order."""
        self.note_steps()
        self.server.end()

    def note_steps(self):
        metrics = self.server.metrics()
        self.lives[-1]["steps"] = metrics["spherule_steps", ""]
        return metrics

    def viewer(self):
        return Viewer(self._port, rate=5, patience=PATIENCE, token=TOKENS["viewer"])

    def watch(self, what):
        """A new viewer gets frames."""
        try:
            self.viewer().wait(lambda one: len(one.of("frame")) > 3, PATIENCE)
        except (AssertionError, OSError) as error:
            self.faults.append(f"{what}: a viewer got no frames: {error}")

    def grows(self, metric, by, what):
        """A figure of /metrics grows, within PATIENCE."""
        before = self.server.metrics()[metric, ""]
        self.check(wait_for(lambda: self.server.metrics()[metric, ""] >= before + by, PATIENCE), f"{what}: {metric} stands still")

    async def stretch(self, seconds, kinds=()):
        """Healthy viewers watch while these kinds of attackers are at work."""
        async with attackers.at_work(self._port, TOKENS, kinds) as at_work:
            (report, code, used), pace = await asyncio.gather(
                watched.viewers(self, self.server, TOKENS["viewer"], seconds), self._pace(seconds))
        self.check(code == 0, f"the load client found faults: {report}")
        return {"frames": watched.rate_of(report), "steps": pace, "used": used, "attackers": at_work}

    async def _pace(self, seconds):
        """Steps per second, from 3 s on, when all have connected."""
        await asyncio.sleep(3)
        first, begun = await asyncio.to_thread(self.server.metrics), time.monotonic()
        await asyncio.sleep(seconds)
        last = await asyncio.to_thread(self.server.metrics)
        return (last["spherule_steps", ""] - first["spherule_steps", ""]) / (time.monotonic() - begun)

    def attack(self, kinds, seconds, pairs=1):
        """Pairs of a quiet and an attacked stretch. Returns both lists of stretches, and the causes that were counted."""
        before = self.server.metrics()
        quiet, attacked = [], []
        for _ in range(pairs):
            quiet.append(asyncio.run(self.stretch(seconds)))
            attacked.append(asyncio.run(self.stretch(seconds, kinds)))
        counted = self.counted(before, kinds)
        return quiet, attacked, counted

    def has_counted(self, before, kinds):
        """Returns whether all that these kinds of attackers cause has been counted since `before`."""
        after = self.server.metrics()
        grown = {*watched.difference(after, before, "spherule_rejected_total"),
                 *watched.difference(after, before, "spherule_sessions_closed_total")}
        return all({*kind.rejected, *kind.closed} <= grown for kind in kinds)

    def counted(self, before, kinds=()):
        """Returns rejections and ends of sessions since `before`. They must be those of these kinds of attackers."""
        time.sleep(1)  # the last attackers leave
        after = self.server.metrics()
        counted = {}
        for family, attribute in (("spherule_rejected_total", "rejected"), ("spherule_sessions_closed_total", "closed")):
            grown = watched.difference(after, before, family)
            must = {cause for kind in kinds for cause in getattr(kind, attribute)}
            may = {"left"}.union(*(kind.may for kind in kinds))
            names = ", ".join(kind.__name__ for kind in kinds) or "no attacker"
            self.check(not must - set(grown), f"{names}: no {', '.join(must - set(grown))} in {family}")
            self.check(not set(grown) - must - may, f"{names}: {', '.join(set(grown) - must - may)} in {family}")
            counted[attribute] = {cause: int(count) for cause, count in grown.items()}
        return counted

    def full_disk(self, seconds):
        """No file can be written for a time. The recording and the log end; checkpoints fail, and then succeed again."""
        before = self.note_steps()
        self._system.fill_disk(True)
        asked = self.steering.ask({"checkpoint": {}})
        self.check("refused" in asked, f"full disk: a checkpoint was written: {asked}")
        time.sleep(seconds)
        self.watch("full disk")
        self.check(wait_for(lambda: self.steering.warned("the command log has ended")),
                   "full disk: the end of the log was not reported")
        self.check(wait_for(lambda: self.server.metrics()["spherule_recording_active", ""] == 0),
                   "full disk: the recording goes on")
        during = self.server.metrics()
        failures = during["spherule_checkpoint_failures_total", ""] - before["spherule_checkpoint_failures_total", ""]
        self.check(failures >= 1, "full disk: no failure of a checkpoint was counted")
        self._system.fill_disk(False)
        self.grows("spherule_checkpoints_total", 1, "room again")
        for command in ("startRecording", "stopRecording"):
            self.check("applied" in (answer := self.steering.ask({command: {}})), f"room again: {command}: {answer}")
            time.sleep(1)
        self.counted(before)
        steps = self.note_steps()["spherule_steps", ""] - before["spherule_steps", ""]
        self.server.end()
        self._logs += 1  # the old one has ended
        self.start()
        self.watch("room again")
        return f"{failures:.0f} checkpoints failed, the recording and the log ended; {steps:.0f} steps meanwhile"

    def lost_device(self):
        """The context of a graphics device is lost: the server ends with 75."""
        self.steering.sends = False  # Mesa would compile kernels for each kind of command
        self.stop()
        self.start("software")
        viewer = self.viewer().wait(lambda one: len(one.of("frame")) > 3)
        self.grows("spherule_checkpoints_total", 1, "before the loss")
        self.note_steps()
        self._driver.strike()
        self.server.wait()  # it notices the loss after the step, which may take long on a busy machine
        self.check(wait_for(lambda: viewer.closed, PATIENCE) and viewer.closed[0] == 1012,
                   f"lost device: the viewer was closed with {viewer.closed}")
        self.check([event for event in viewer.of("event") if event["kind"] == "DEVICE_LOST"],
                   "lost device: the viewer was not notified")
        self._driver.heal()
        self.start("software", expected=75)
        self.watch("lost device")
        self.stop()
        self.start()
        self.steering.sends = True
        return "the server ended with 75, and viewers were notified"

    def clock_jumps(self, seconds, offsets=(3600, -7200, 10 * 365 * 86400, 0)):
        """The wall clock jumps to each of these offsets, and stays for a time."""
        before = self.note_steps()
        viewer = self.viewer().wait(lambda one: one.of("frame"))
        for offset in offsets:
            self._system.set_clock(offset)
            what, frames = f"the clock is wrong by {offset} s", len(viewer.of("frame"))
            for command in ("stopRecording", "startRecording", "checkpoint"):
                asked = time.monotonic()
                answer = self.steering.ask({command: {}})
                self.check("applied" in answer, f"{what}: {command}: {answer}")
                if command == "stopRecording":  # its end is written by another thread
                    self.check(wait_for(lambda: self.server.metrics()["spherule_recording_active", ""] == 0, PATIENCE),
                               f"{what}: the recording does not end")
            time.sleep(seconds)
            self.grows("spherule_checkpoints_total", 1, what)
            self.check(len(viewer.of("frame")) > frames, f"{what}: no frames")
            age = self.server.metrics()["spherule_checkpoint_age_seconds", ""]
            self.check(0 <= age <= time.monotonic() - asked, f"{what}: the age of the checkpoint is {age} s")
        self.check(viewer.closed is None, f"clock jumps: the viewer was closed: {viewer.closed}")
        self.counted(before)
        steps = self.note_steps()["spherule_steps", ""] - before["spherule_steps", ""]
        return f"offsets of {', '.join(map(str, offsets))} s: no session closed; {steps:.0f} steps meanwhile"

    def stopped_process(self, seconds):
        """The process is stopped as a whole, and continues."""
        before = self.note_steps()
        viewer = self.viewer().wait(lambda one: one.of("frame"))
        os.kill(self.server.pid, signal.SIGSTOP)
        time.sleep(seconds)
        os.kill(self.server.pid, signal.SIGCONT)
        frames = len(viewer.of("frame"))
        self.grows("spherule_steps", STEPS_PER_SECOND, "SIGCONT")
        self.check(wait_for(lambda: len(viewer.of("frame")) > frames), "SIGCONT: no frames")
        self.check(viewer.closed is None, f"SIGCONT: the viewer was closed: {viewer.closed}")
        self.check(self.server.get("/healthz") == "alive\n", "SIGCONT: the server is not healthy")
        self.counted(before)
        return f"stopped for {seconds} s: no session closed"

    def killed(self, after):
        """The process is killed `after` some time (s)."""
        self.watch("SIGKILL")
        time.sleep(after)
        self.note_steps()
        self.server.end(kill=True)
        self.start(expected=-signal.SIGKILL)

    def end(self):
        """Stops the server in order and all clients, and checks what each life has lost. Returns the largest loss in steps."""
        self.watch("at the end")
        self.stop()
        self._ended(0)
        self.steering.stop()
        losses = [0]
        for number, (life, following) in enumerate(zip(self.lives, self.lives[1:]), 2):
            saved, began = life["server"].last_checkpoint(), following["server"].went_on_from()
            self.check(began is not None and began >= saved and "passed over" not in following["server"].output,
                       f"life {number} did not go on from step {saved}, which is on the disk: {following['server'].output}")
            losses.append(life["steps"] - (began or 0))
        return max(losses)

    def close(self):
        self.server.end(kill=True)

    def replays(self):
        """Replays all logs. Returns a line for each."""
        lines = []
        for number in range(1, self._logs + 1):
            done = runner(self._program, timeout=3600)("replay", os.path.join(self._folder, f"commands-{number}.sphl"),
                                                       "--device", "cpu", "--json")
            full = number < self._logs  # the disk was full at its end
            report = json.loads(done.stdout) if done.stdout else {"same": False}
            whole = done.returncode == 0 and report["complete"]
            cut = done.returncode == 0 or done.returncode == 2 and "is cut off" in done.stderr
            self.check(report["same"] and report["hashes"] > 0 and (cut and not whole if full else whole),
                       f"log {number}: {done.stdout}{done.stderr}")
            if report["same"]:
                lines.append(f"{report['steps']} steps, {report['commands']} commands, {report['hashes']} equal hashes"
                             + (", up to the full disk" if full else ""))
        self.check(not glob.glob(os.path.join(self._folder, "commands-*-*.sphl")), "a life did not go on with the log")
        return lines

    def exports(self):
        """Exports all recordings. Returns how many have frames."""
        readable = 0
        paths = glob.glob(os.path.join(self._folder, "*.sph")) + glob.glob(os.path.join(self._folder, "recordings/*.sph"))
        for path in paths:
            done = runner(self._program, timeout=600)("export", path, "--format", "csv", "--out", path + ".csv", "--every", "1s")
            readable += done.returncode == 0
            self.check(done.returncode == 0 or "has no frames" in done.stderr, f"{path} cannot be read: {done.stderr}")
            if done.returncode == 0:
                os.remove(path + ".csv")
        self.check(readable > 0, "no recording has frames")
        return f"{readable} of {len(paths)}"
