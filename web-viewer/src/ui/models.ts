import { Model } from "../gen/spherule/v1/scene_pb";

/** The ways to compute contacts, with what each is good for. */
export const models = [
  { model: Model.FAST, name: "Fast", says: "impulses, few substeps; for very many in the air, sinks in deep piles" },
  { model: Model.BALANCED, name: "Balanced", says: "the default; piles come to rest" },
  { model: Model.ACCURATE, name: "Accurate", says: "soft spheres that forces push apart; many substeps, so it is slow" },
];

export function nameOf(model: Model): string {
  return models.find((candidate) => candidate.model === model)?.name ?? "Unknown";
}
