import { create } from "@bufbuild/protobuf";
import type { MessageInitShape } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { SceneFactsSchema } from "../src/gen/spherule/v1/facts_pb";
import { factsOf } from "../src/model/facts";
import { lightFor } from "../src/renderer/light";
import type { Light } from "../src/renderer/light";
import { themes } from "../src/renderer/theme";

function lightOf(light?: MessageInitShape<typeof SceneFactsSchema>["light"]): Light {
  const bounds = { boundsMin: [-1, -2, 0], boundsMax: [3, 2, 1] };
  return lightFor(factsOf(create(SceneFactsSchema, { epoch: 1, ...bounds, ...(light && { light }) })), themes.light);
}

function close(actual: readonly number[], expected: readonly number[]): void {
  assert.equal(actual.length, expected.length);
  actual.forEach((x, i) => assert.ok(Math.abs(x - (expected[i] as number)) < 1e-6, `${actual} is not ${expected}`));
}

test("without a light of the scene, strengths and colours are the theme's", () => {
  const { direction, key, sky, ground } = lightOf();
  assert.deepEqual([key, sky, ground], [themes.light.key, themes.light.sky, themes.light.ground]);
  close([Math.hypot(...direction)], [1]);
});

test("a scene sets direction, colour and strengths", () => {
  const { direction, key, sky } = lightOf({ direction: [0, -3, 4], strength: 2, colour: "#ff8000", sky: 0.5 });
  close(direction, [0, -0.6, 0.8]);
  close(key, [2 * 0.86, 2 * 0.86 * (128 / 255) ** 2, 0]);
  close(
    sky,
    themes.light.sky.map((part) => part / 2),
  );
});

test("the shadow map covers the bounds from every direction, straight from above and below, too", () => {
  for (const direction of [
    [0, 0, 1],
    [0, 0, -1],
    [1, 2, 3],
    [-1, 0, 0],
  ]) {
    const { map } = lightOf({ direction });
    for (let corner = 0; corner < 8; corner++) {
      const [x, y, z] = [corner & 1 ? 2 : -2, corner & 2 ? 2 : -2, corner & 4 ? 0.5 : -0.5] as const;
      for (let row = 0; row < 3; row++) {
        const at = map[row]! * x + map[4 + row]! * y + map[8 + row]! * z + map[12 + row]!;
        assert.ok(at >= 0 && at <= 1, `${direction}: ${at}`);
      }
    }
  }
});
