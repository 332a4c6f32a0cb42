import assert from "node:assert/strict";
import { test } from "node:test";
import { Camera } from "../src/camera/camera";
import { keysFor } from "../src/ui/keys";

test("for a recording, no key drops, pushes or removes spheres, and descriptions fit", () => {
  const none = (): void => undefined;
  const buttons = { toggle: none, step: none, reset: none, panel: none, help: none, home: none, follow: none };
  const others = { colour: none, push: none, lock: none, drop: none, remove: none, deselect: none, present: none };
  const actions = { ...buttons, ...others, camera: new Camera() };
  const textsFor = (playing: boolean): string[] => keysFor(actions, playing).map((key) => key.description);
  const [live, played] = [textsFor(false), textsFor(true)];
  const missing = live.filter((text) => !played.includes(text));
  const simulated = ["one step", "reset the scene", "drop spheres", "push mode", "remove the selected sphere"];
  assert.deepEqual(missing, [...simulated, "from the past back to live"]);
  assert.deepEqual(played.filter((text) => !live.includes(text)), ["one frame", "go to the beginning"]);
});
