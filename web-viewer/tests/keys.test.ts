import assert from "node:assert/strict";
import { test } from "node:test";
import { Camera } from "../src/camera/camera";
import { keysFor } from "../src/ui/keys";

test("for a recording, no key drops, pushes or removes spheres, and descriptions fit", () => {
  const none = (): void => undefined;
  const buttons = { toggle: none, step: none, reset: none, panel: none, help: none, home: none, follow: none };
  const steering = { middle: none, move: () => false };
  const spheres = { push: none, drop: none, remove: none, deselect: none };
  const others = { ...steering, ...spheres, colour: none, lock: none, present: none };
  const actions = { ...buttons, ...others, camera: new Camera() };
  const textsFor = (playing: boolean): string[] => keysFor(actions, playing).map((key) => key.description);
  const [live, played] = [textsFor(false), textsFor(true)];
  const missing = live.filter((text) => !played.includes(text));
  const simulated = ["one step", "reset the scene", "drop spheres", "push mode", "remove the selected sphere"];
  const depths = ["move the pulled sphere away, nearer", "move the pulled sphere away, nearer"];
  const arrows = Array.from({ length: 4 }, () => "orbit, or move the pulled sphere");
  assert.deepEqual(missing, [...simulated, ...depths, "from the past back to live", ...arrows]);
  const orbits = Array.from({ length: 4 }, () => "orbit");
  assert.deepEqual(
    played.filter((text) => !live.includes(text)),
    ["one frame", "go to the beginning", ...orbits],
  );
});
