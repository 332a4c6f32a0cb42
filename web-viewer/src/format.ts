const gap = "\u202f"; // narrow no-break space

/** Adds a capital and a full stop. */
export function sentence(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1).replace(/[.\s]*$/, ".");
}

const absent = "–";

/** An integer with groups of three digits, as in 12\u202f345; from 10¹⁵ on, a power of ten. */
export function count(value: number | bigint): string {
  if (typeof value === "number" && !Number.isFinite(value)) return absent;
  if (Math.abs(Number(value)) >= 1e15) return power(Number(value));
  return signed(BigInt(Math.round(Number(value))).toString()).replace(/\B(?=(\d{3})+(?!\d))/g, gap);
}

/** Three significant digits without trailing zeros; very small and very large numbers with a power of ten. */
export function figure(value: number): string {
  if (!Number.isFinite(value)) return absent;
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e9) return power(value);
  if (size >= 1e5) return count(value);
  if (size < 1e-3) return signed(value.toExponential(1)).replace("e-", "e−");
  const digits = Math.max(0, 2 - Math.floor(Math.log10(size)));
  return signed(trimmed(value.toFixed(Math.min(4, digits))));
}

const prefixes: [size: number, prefix: string][] = [
  [1e12, "T"],
  [1e9, "G"],
  [1e6, "M"],
  [1e3, "k"],
  [1, ""],
  [1e-3, "m"],
  [1e-6, "µ"],
  [1e-9, "n"],
];

/** Three significant digits with a unit that takes SI prefixes, as in 12.3 mJ. */
export function withPrefix(value: number, unit: string): string {
  if (!Number.isFinite(value)) return absent;
  if (value === 0) return `0 ${unit}`;
  const rounded = Number(value.toPrecision(3)); // 999.9 becomes 1000, which has another prefix
  const size = Math.abs(rounded);
  const fitting = prefixes.find(([least]) => size >= least);
  if (!fitting || size >= 1e15) return `${figure(value)} ${unit}`;
  return `${figure(rounded / fitting[0])} ${fitting[1]}${unit}`;
}

/** A share, as in 2.5 %. */
export function percent(share: number): string {
  return `${figure(100 * share)} %`;
}

/** A length in km, m, cm, mm or µm. */
export function length(metres: number): string {
  if (!Number.isFinite(metres)) return absent;
  const size = Math.abs(metres);
  if (size >= 1e7) return `${figure(metres)} m`;
  if (size >= 1e4) return `${figure(metres / 1e3)} km`;
  if (size >= 1 || size === 0) return `${figure(metres)} m`;
  if (size >= 0.01) return `${figure(metres * 100)} cm`;
  if (size >= 1e-3) return `${figure(metres * 1000)} mm`;
  return withPrefix(metres, "m");
}

const minute = 60; // s
const hour = 60 * minute;
const day = 24 * hour;
const week = 7 * day;

/** A duration (s) of any length, as in 12.30 s, 2 min 5 s, 1 h 20 min, 3 d 4 h, 2 weeks 1 d. */
export function seconds(value: number): string {
  if (!Number.isFinite(value)) return absent;
  const size = Math.abs(value);
  if (value < 0) return `−${seconds(size)}`;
  if (size > 0 && size < 0.01) return withPrefix(value, "s");
  if (size < 100) return `${value.toFixed(2)} s`;
  const parts = (large: number, largeUnit: string, small: number, smallUnit: string): string => {
    const smalls = Math.floor(value / small);
    const perLarge = large / small;
    return `${count(Math.floor(smalls / perLarge))} ${largeUnit} ${smalls % perLarge} ${smallUnit}`;
  };
  if (size < hour) return parts(minute, "min", 1, "s");
  if (size < day) return parts(hour, "h", minute, "min");
  if (size < 2 * week) return parts(day, "d", hour, "h");
  if (size < 1e3 * week) return parts(week, "weeks", day, "d");
  return `${figure(value)} s`;
}

export function bytes(value: number): string {
  if (!Number.isFinite(value)) return absent;
  if (value >= 1e12) return `${figure(value / 1e12)} TB`;
  if (value >= 1e9) return `${(value / 1e9).toFixed(value < 1e10 ? 2 : 1)} GB`;
  if (value >= 1e5) return `${(value / 1e6).toFixed(value < 1e8 ? 1 : 0)} MB`;
  return `${(value / 1e3).toFixed(0)} kB`;
}

export function bytesPerSecond(value: number): string {
  if (!Number.isFinite(value)) return absent;
  if (value >= 1e9) return `${figure(value / 1e9)} GB/s`;
  if (value >= 1e5) return `${(value / 1e6).toFixed(value < 1e7 ? 2 : 1)} MB/s`;
  return `${(value / 1e3).toFixed(0)} kB/s`;
}

export function bitsPerSecond(bytes: number): string {
  return Number.isFinite(bytes) ? `${figure((8 * bytes) / 1e6)} Mb/s` : absent;
}

/** The components of a vector, with the same number of digits after the point; very large or small ones as figures. */
export function vector(values: readonly number[], digits = 2): string {
  const least = 10 ** -digits;
  const fits = (value: number): boolean => value === 0 || (Math.abs(value) < 1e5 && Math.abs(value) >= least / 2);
  const largest = Math.max(...values.map(Math.abs));
  const text = (value: number): string => {
    if (!Number.isFinite(value)) return absent;
    // Beside larger components a small one is 0.
    return fits(largest) ? signed(value.toFixed(digits)).replace(/^−(?=[0.]*$)/, "") : figure(value);
  };
  return values.map(text).join("  ");
}

function power(value: number): string {
  return signed(
    value
      .toExponential(2)
      .replace("e+", "e")
      .replace(/\.?0+(?=e)/, ""),
  );
}

function trimmed(text: string): string {
  return text.replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, "");
}

function signed(text: string): string {
  return text.replace(/^-/, "−");
}

/** m:ss, h:mm:ss or days and h:mm:ss; fractions of a second are cut off. */
export function clockTime(seconds: number): string {
  if (!Number.isFinite(seconds)) return absent;
  if (seconds >= day) return `${count(Math.floor(seconds / day))} d ${clockTime(seconds % day)}`;
  const whole = Math.max(0, Math.floor(seconds));
  const two = (value: number): string => String(value).padStart(2, "0");
  const hours = Math.floor(whole / 3600);
  const minutes = Math.floor(whole / 60) % 60;
  return hours > 0 ? `${hours}:${two(minutes)}:${two(whole % 60)}` : `${minutes}:${two(whole % 60)}`;
}

/** A time in a recording of this duration (s). */
export function recordingTime(time: number, duration: number): string {
  if (!Number.isFinite(time)) return absent;
  if (duration >= 60) return clockTime(time);
  const digits = duration >= 1 || duration <= 0 ? 2 : Math.min(9, 2 - Math.floor(Math.log10(duration)));
  return `${time.toFixed(digits)} s`;
}
