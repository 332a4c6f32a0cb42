import { create } from "@bufbuild/protobuf";
import { GroupFactsSchema } from "../gen/spherule/v1/facts_pb";
import type { GroupFacts, SceneFacts } from "../gen/spherule/v1/facts_pb";

/**
 * The spheres of one population, without places that are not in use. As in every recording, their ids are the numbers
 * from 0 on, in the order of their ids in the simulation.
 */
export interface Spheres {
  facts: SceneFacts;
  order: Uint8Array; // ids as in messages
  chosen: Uint32Array; // for each sphere in this order, its number in frames of the places
}

/** `facts`: of places; `order`: the place of each sphere in frames. Undefined if there are no spheres. */
export function spheresOf(facts: SceneFacts, order: Uint32Array): Spheres | undefined {
  const { ids, groupAt } = tableOf(facts);
  const used = Uint32Array.from(ids.keys()).filter((place) => (ids[place] as number) >= 0);
  if (used.length === 0) return undefined;
  used.sort((a, b) => (ids[a] as number) - (ids[b] as number));
  const rank = new Int32Array(facts.count).fill(-1);
  used.forEach((place, k) => (rank[place] = k));
  const chosen = Uint32Array.from(order.keys()).filter((k) => (rank[order[k] as number] as number) >= 0);
  const bytes = new Uint8Array(3 * chosen.length);
  chosen.forEach((k, at) => {
    const id = rank[order[k] as number] as number;
    bytes.set([id & 255, (id >> 8) & 255, id >> 16], 3 * at);
  });
  const groups = groupsOf(facts.groups, used, groupAt);
  const radii = facts.radius > 0 ? new Uint8Array(0) : radiiOf(facts.radii, used);
  const own = { groups, radii, places: [], population: 0, count: used.length };
  return { facts: { ...facts, ...own }, order: bytes, chosen };
}

/** The id of the sphere at each place, negative if there is none, and the number of its group. */
function tableOf({ count, places, groups }: SceneFacts): { ids: Float64Array; groupAt: Uint32Array } {
  const ids = new Float64Array(count).fill(-1);
  const groupAt = new Uint32Array(count);
  for (const { first, count: length, id, group } of places) {
    for (let k = 0; k < length && first + k < count; k++) ids[first + k] = Number(id) + k;
    groupAt.fill(group, first, first + length);
  }
  if (places.length > 0) return { ids, groupAt };
  groups.forEach((group, k) => groupAt.fill(k, group.first, group.first + group.count));
  return { ids: ids.map((_, place) => place), groupAt };
}

/** Groups as recordings have them: of consecutive ids. One that is interrupted by others is divided. */
function groupsOf(groups: readonly GroupFacts[], used: Uint32Array, groupAt: Uint32Array): GroupFacts[] {
  const divided: GroupFacts[] = [];
  let before = -1;
  used.forEach((place, id) => {
    const number = groupAt[place] as number;
    const last = divided.at(-1);
    if (last && number === before) last.count += 1;
    else divided.push({ ...(groups[number] ?? create(GroupFactsSchema)), first: id, count: 1 });
    before = number;
  });
  return divided;
}

function radiiOf(bytes: Uint8Array, used: Uint32Array): Uint8Array {
  const radii = new Uint8Array(4 * used.length);
  used.forEach((place, k) => radii.set(bytes.subarray(4 * place, 4 * place + 4), 4 * k));
  return radii;
}
