// Random numbers from a seed: xorshift of 32 bits.
let state = 1;

export function seedRandom(seed) {
  state = seed >>> 0 || 1;
  for (let k = 0; k < 10; k++) word();
}

/** 0 .. 2^32 - 1. */
export function word() {
  state ^= state << 13;
  state ^= state >>> 17;
  state ^= state << 5;
  return state >>> 0;
}

/** 0 .. below - 1. */
export function draw(below) {
  return word() % below;
}
