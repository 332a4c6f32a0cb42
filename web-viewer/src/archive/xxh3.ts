/** XXH3 with 64 bits and seed 0 (https://github.com/Cyan4973/xxHash), as recordings use it for checksums. */

const secretDigits =
  "b8fe6c3923a44bbe7c01812cf721ad1cded46de9839097db7240a4a4b7b3671fcb79e64eccc0e578825ad07dccff7221" +
  "b8084674f743248ee03590e6813a264c3c2852bb91c300cb88d0658b1b532ea371644897a20df94e3819ef46a9deacd8" +
  "a8fa763fe39c343ff9dcbbc7c70b4f1d8a51e04bcdb45931c89f7ec9d9787364eac5ac8334d3ebc3c581a0fffa1363eb" +
  "170ddd51b7f0da49d316552629d4689e2b16be587d47a1fc8ff8b8d17ad031ce45cb3a8f95160428afd7fbcabb4b407e";

const secret = new DataView(Uint8Array.from(secretDigits.match(/../g) ?? [], (byte) => parseInt(byte, 16)).buffer);
const secretBytes = secret.byteLength;

const stripe = 64; // bytes
const stripes = 16; // per block
const block = stripe * stripes;
const lanes = 8;

const [prime32a, prime32b, prime32c] = [0x9e3779b1, 0x85ebca77, 0xc2b2ae3d];
const prime64a = 0x9e3779b185ebca87n;

/** The hash of the bytes. */
export function xxh3(bytes: Uint8Array): bigint {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.byteLength > 240) return long(view);
  if (bytes.byteLength > 128) return middle(view);
  if (bytes.byteLength > 16) return short(view);
  if (bytes.byteLength > 8) return shortest(view);
  throw new RangeError("fewer than 9 bytes are hashed");
}

const wrap = (value: bigint): bigint => BigInt.asUintN(64, value);

function fold(a: bigint, b: bigint): bigint {
  const product = a * b;
  return wrap(product) ^ (product >> 64n);
}

function avalanche(hash: bigint): bigint {
  const mixed = wrap((hash ^ (hash >> 37n)) * 0x165667919e3779f9n);
  return mixed ^ (mixed >> 32n);
}

/** Mixes 16 bytes with 16 bytes of the secret. */
function mix(view: DataView, at: number, key: number): bigint {
  const low = view.getBigUint64(at, true) ^ secret.getBigUint64(key, true);
  const high = view.getBigUint64(at + 8, true) ^ secret.getBigUint64(key + 8, true);
  return fold(low, high);
}

function seeded(length: number): bigint {
  return wrap(BigInt(length) * prime64a);
}

/** 9 to 16 bytes. */
function shortest(view: DataView): bigint {
  const { byteLength: length } = view;
  const key = (at: number): bigint => secret.getBigUint64(at, true) ^ secret.getBigUint64(at + 8, true);
  const low = view.getBigUint64(0, true) ^ key(24);
  const high = view.getBigUint64(length - 8, true) ^ key(40);
  const swapped = new DataView(new ArrayBuffer(8));
  swapped.setBigUint64(0, low, true);
  return avalanche(wrap(BigInt(length) + swapped.getBigUint64(0, false) + high + fold(low, high)));
}

/** 17 to 128 bytes. */
function short(view: DataView): bigint {
  const { byteLength: length } = view;
  let sum = seeded(length);
  for (let k = 0; k <= (length - 1) >> 5; k++) {
    sum += mix(view, 16 * k, 32 * k) + mix(view, length - 16 * (k + 1), 32 * k + 16);
  }
  return avalanche(wrap(sum));
}

/** 129 to 240 bytes. */
function middle(view: DataView): bigint {
  const { byteLength: length } = view;
  const rounds = length >> 4;
  let sum = seeded(length);
  for (let k = 0; k < 8; k++) sum += mix(view, 16 * k, 16 * k);
  sum = avalanche(wrap(sum));
  for (let k = 8; k < rounds; k++) sum += mix(view, 16 * k, 16 * (k - 8) + 3);
  return avalanche(wrap(sum + mix(view, length - 16, 136 - 17)));
}

// The sums of 64 bits of long inputs are pairs of 32 bits, the lower one first: arithmetic on bigints is far slower.

const initial = [
  BigInt(prime32c),
  prime64a,
  0xc2b2ae3d27d4eb4fn,
  0x165667b19e3779f9n,
  0x85ebca77c2b2ae63n,
  BigInt(prime32b),
  0x27d4eb2f165667c5n,
  BigInt(prime32a),
];

function long(view: DataView): bigint {
  const { byteLength: length } = view;
  const sums = new Uint32Array(2 * lanes);
  initial.forEach((value, lane) => {
    sums[2 * lane] = Number(value & 0xffffffffn);
    sums[2 * lane + 1] = Number(value >> 32n);
  });
  const blocks = Math.floor((length - 1) / block);
  for (let k = 0; k < blocks; k++) {
    for (let n = 0; n < stripes; n++) accumulate(sums, view, block * k + stripe * n, 8 * n);
    scramble(sums);
  }
  const rest = Math.floor((length - 1 - block * blocks) / stripe);
  for (let n = 0; n < rest; n++) accumulate(sums, view, block * blocks + stripe * n, 8 * n);
  accumulate(sums, view, length - stripe, secretBytes - stripe - 7);
  return merged(sums, length);
}

function accumulate(sums: Uint32Array, view: DataView, at: number, key: number): void {
  for (let lane = 0; lane < lanes; lane++) {
    const low = view.getUint32(at + 8 * lane, true);
    const high = view.getUint32(at + 8 * lane + 4, true);
    add(sums, 2 * (lane ^ 1), low, high);
    multiplyAdd(
      sums,
      2 * lane,
      (low ^ secret.getUint32(key + 8 * lane, true)) >>> 0,
      (high ^ secret.getUint32(key + 8 * lane + 4, true)) >>> 0,
    );
  }
}

function add(sums: Uint32Array, at: number, low: number, high: number): void {
  const sum = (sums[at] as number) + low;
  sums[at] = sum;
  sums[at + 1] = (sums[at + 1] as number) + high + (sum > 0xffffffff ? 1 : 0);
}

/** Adds the product of two numbers of 32 bits. */
function multiplyAdd(sums: Uint32Array, at: number, a: number, b: number): void {
  const [al, ah, bl, bh] = [a & 0xffff, a >>> 16, b & 0xffff, b >>> 16];
  const low = al * bl;
  const crossed = (low >>> 16) + ((al * bh) & 0xffff) + ((ah * bl) & 0xffff);
  const high = ah * bh + ((al * bh) >>> 16) + ((ah * bl) >>> 16) + (crossed >>> 16);
  add(sums, at, ((crossed << 16) | (low & 0xffff)) >>> 0, high);
}

function scramble(sums: Uint32Array): void {
  for (let lane = 0; lane < lanes; lane++) {
    const [low, high] = [sums[2 * lane] as number, sums[2 * lane + 1] as number];
    const key = secretBytes - stripe + 8 * lane;
    const mixedLow = (low ^ (high >>> 15) ^ secret.getUint32(key, true)) >>> 0;
    const mixedHigh = (high ^ secret.getUint32(key + 4, true)) >>> 0;
    sums[2 * lane] = 0;
    sums[2 * lane + 1] = Math.imul(mixedHigh, prime32a);
    multiplyAdd(sums, 2 * lane, mixedLow, prime32a);
  }
}

function merged(sums: Uint32Array, length: number): bigint {
  const view = new DataView(sums.buffer);
  const sum = (lane: number): bigint => {
    return (BigInt(view.getUint32(8 * lane + 4, true)) << 32n) | BigInt(view.getUint32(8 * lane, true));
  };
  let hash = seeded(length);
  for (let k = 0; k < lanes; k += 2) {
    const key = 11 + 8 * k;
    hash += fold(sum(k) ^ secret.getBigUint64(key, true), sum(k + 1) ^ secret.getBigUint64(key + 8, true));
  }
  return avalanche(wrap(hash));
}
