import { observed } from "../observed";
import type { Population } from "./population";

/** The selected sphere. It stays selected as long as it exists. */
export class Selection {
  @observed accessor id: number | undefined; // undefined: no sphere is selected
  @observed accessor place: number | undefined; // of the sphere in frames
  @observed accessor followed = false; // the camera follows the sphere

  /** Selects the sphere at a place; deselects if there is none. */
  select(population: Population | undefined, place: number | undefined): void {
    this.id = place === undefined ? undefined : population?.idOf(place);
    this.place = this.id === undefined ? undefined : place;
  }

  clear(): void {
    this.id = this.place = undefined;
    this.followed = false;
  }

  /** Finds the sphere in a population that has changed; deselects it if it is gone. */
  follow(population: Population): void {
    if (this.id === undefined || this.place === undefined) return;
    if (population.idOf(this.place) !== this.id) this.place = population.placeOf(this.id);
    if (this.place === undefined) this.clear();
  }
}
