// A session without a connection, and the positions of its states: the test plays the worker.
import { create } from "@bufbuild/protobuf";
import type { MessageInitShape } from "@bufbuild/protobuf";
import { noTurns } from "../../src/codec/turns";
import type { Positions } from "../../src/columns";
import { PopulationSchema, SceneFactsSchema } from "../../src/gen/spherule/v1/facts_pb";
import type { Run } from "../../src/model/population";
import { Session } from "../../src/model/session";
import type { State } from "../../src/model/states";

const cube = { boundsMin: [-1, -1, -1], boundsMax: [1, 1, 1] };

/** Positions in a state, from coordinates (m, relative to the centre of the bounds). */
export function positionsAt(metres: readonly number[], quantum = 0.01): Positions {
  const values = Int32Array.from(metres, (x) => Math.round(x / quantum));
  return { values, quantum, quanta: [quantum, quantum, quantum], turns: noTurns };
}

export function createSession() {
  const changes: Run[][] = [];
  const faults: string[] = [];
  const dropped: State[] = [];
  let scenes = 0;
  const none = (): void => undefined;
  const session = new Session((state) => void dropped.push(state), {
    linkChanged: none,
    welcomed: none,
    sceneChanged: () => (scenes += 1),
    populationChanged: (_, changed) => void changes.push(changed),
    eventReceived: none,
    recordingChanged: none,
    orderChanged: none,
    messageUnreadable: (reason) => void faults.push(reason),
    saved: none,
    told: (_, text) => void faults.push(text),
  });
  let sequence = 0;
  return {
    session,
    changes, // of the population, as the session reported them
    faults, // messages that the session reported as unreadable
    dropped, // states that will not be shown any more
    scenes: () => scenes, // number of reported scenes
    /** Facts of a cube in epoch 3 with spheres of equal radius, unless `fields` say otherwise. */
    scene(fields: MessageInitShape<typeof SceneFactsSchema> = {}): void {
      session.handle({ kind: "scene", facts: create(SceneFactsSchema, { epoch: 3, radius: 0.5, ...cube, ...fields }) });
    },
    population(number: number, fields: MessageInitShape<typeof PopulationSchema> = {}): void {
      session.handle({ kind: "population", population: create(PopulationSchema, { epoch: 3, number, ...fields }) });
    },
    /** A frame a tenth of a second after the last one, with a sphere at each of `xs` on the x axis. */
    frame(population: number, xs: number[], epoch = 3, quantum = 0.25): void {
      sequence += 1;
      const times = { sequence, step: sequence, simTime: sequence / 10, arrival: 100 * sequence, ready: 0 };
      const position = positionsAt(
        xs.flatMap((x) => [x, 0, 0]),
        quantum,
      );
      const drawing = { columns: { position }, order: 1, boxes: new Float64Array(0), poses: [] };
      const rest = { count: xs.length, ...drawing, bytes: 0, decodeMs: 0, status: undefined };
      session.handle({ kind: "frame", frame: { ...times, ...rest, epoch, population } });
    },
  };
}
