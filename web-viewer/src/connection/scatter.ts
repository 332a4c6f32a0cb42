/** Positions in the order of frames, in units of the grid, to metres in id order; `places` as placesOf() gives them. */
export function scatter(units: Int32Array, places: Uint32Array, quantum: number, metres: Float32Array): void {
  for (let k = 0, from = 0; k < places.length; k++, from += 3) {
    const to = places[k] as number;
    metres[to] = quantum * (units[from] as number);
    metres[to + 1] = quantum * (units[from + 1] as number);
    metres[to + 2] = quantum * (units[from + 2] as number);
  }
}
