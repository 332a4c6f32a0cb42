import assert from "node:assert/strict";
import { test } from "node:test";
import { fragmentOf, linkIn } from "../src/model/page_link";
import type { PageLink } from "../src/model/page_link";

const whole: PageLink = {
  scene: "box-10k",
  camera: { eye: [1.25, -2, 0.5], target: [0, 0.125, 0] },
  colour: "group",
  sphere: 1234,
};

test("a link is read as it was written", () => {
  const text = "#scene=box-10k&camera=1.25,-2,0.5,0,0.125,0&colour=group&sphere=1234";
  assert.equal(fragmentOf(whole), text);
  assert.deepEqual(linkIn(text), { link: whole, faults: [] });
});

test("names of scenes may have any characters", () => {
  for (const scene of ["a & b=c#d?e", "100 %", "\u05e9\u05dc\u05d5\u05dd", "x+y,z"]) {
    assert.deepEqual(linkIn(fragmentOf({ scene })).link, { scene });
  }
});

test("an absent part is not in the link", () => {
  assert.equal(fragmentOf({ scene: "pour", sphere: undefined }), "#scene=pour");
  assert.deepEqual(linkIn("#scene=pour"), { link: { scene: "pour" }, faults: [] });
});

test("a bad part is ignored, named, and spoils no other part", () => {
  const bad: [string, RegExp][] = [
    ["camera=1,2,3", /camera/],
    ["camera=1,2,3,4,5,x", /camera/],
    ["camera=1,2,3,4,5,", /camera/],
    ["camera=0,0,0,0,0,0", /camera/],
    ["camera=1e10,0,0,0,0,0", /camera/],
    ["camera=NaN,0,0,0,0,1", /camera/],
    ["colour=pink", /colour mode “pink”.*speed/],
    ["sphere=-1", /“-1” is not the number of a sphere/],
    ["sphere=1e3", /“1e3”/],
    ["scene=", /no name/],
    ["token=secret", /“token”/],
    [`${"x".repeat(99)}=1`, /“x{40}…”/],
  ];
  for (const [part, fault] of bad) {
    const name = part.split("=")[0] as keyof PageLink;
    const { [name]: _, ...rest } = whole;
    const { link, faults } = linkIn(`${fragmentOf(rest)}&${part}`);
    assert.equal(faults.length, 1, part);
    assert.match(faults[0] ?? "", fault);
    const read = Object.fromEntries(Object.entries(link).filter(([, value]) => value !== undefined && value !== ""));
    assert.deepEqual(read, rest, part);
  }
});

test("positions keep six digits", () => {
  const fragment = fragmentOf({ camera: { eye: [1 / 3, 2e-9, 12345678], target: [0, 0, 0] } });
  assert.equal(fragment, "#camera=0.333333,2e-9,12345700,0,0,0");
});
