const gap = "\u202f"; // narrow no-break space

/** Adds a capital and a full stop. */
export function sentence(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1).replace(/[.\s]*$/, ".");
}

/** An integer with groups of three digits, as in 12 345. */
export function count(value: number): string {
  return Math.round(value)
    .toString()
    .replace(/\B(?=(\d{3})+(?!\d))/g, gap);
}

/** Three significant digits without trailing zeros; very small numbers with a power of ten. */
export function figure(value: number): string {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e5) return count(value);
  if (size < 1e-3) return value.toExponential(1).replace("e-", "e−").replace(/^-/, "−");
  const digits = Math.max(0, 2 - Math.floor(Math.log10(size)));
  return value.toFixed(Math.min(4, digits)).replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, "").replace("-", "−");
}

/** A length in m, cm or mm. */
export function length(metres: number): string {
  const size = Math.abs(metres);
  if (size >= 1 || size === 0) return `${figure(metres)} m`;
  if (size >= 0.01) return `${figure(metres * 100)} cm`;
  return `${figure(metres * 1000)} mm`;
}

export function seconds(value: number): string {
  return `${value.toFixed(value < 1000 ? 2 : 0)} s`;
}

export function bytes(value: number): string {
  if (value >= 1e9) return `${(value / 1e9).toFixed(value < 1e10 ? 2 : 1)} GB`;
  if (value >= 1e5) return `${(value / 1e6).toFixed(value < 1e8 ? 1 : 0)} MB`;
  return `${(value / 1e3).toFixed(0)} kB`;
}

export function bytesPerSecond(value: number): string {
  if (value >= 1e5) return `${(value / 1e6).toFixed(value < 1e7 ? 2 : 1)} MB/s`;
  return `${(value / 1e3).toFixed(0)} kB/s`;
}

export function bitsPerSecond(bytes: number): string {
  return `${figure((8 * bytes) / 1e6)} Mb/s`;
}

export function vector(values: readonly number[], digits = 2): string {
  return values.map((value) => value.toFixed(digits).replace("-", "−")).join("  ");
}

/** m:ss or h:mm:ss; fractions of a second are cut off. */
export function clockTime(seconds: number): string {
  const whole = Math.max(0, Math.floor(seconds));
  const two = (value: number): string => String(value).padStart(2, "0");
  const hours = Math.floor(whole / 3600);
  const minutes = Math.floor(whole / 60) % 60;
  return hours > 0 ? `${hours}:${two(minutes)}:${two(whole % 60)}` : `${minutes}:${two(whole % 60)}`;
}

/** A time in a recording of this duration (s). */
export function recordingTime(time: number, duration: number): string {
  if (duration >= 60) return clockTime(time);
  const digits = duration >= 1 || duration <= 0 ? 2 : Math.min(9, 2 - Math.floor(Math.log10(duration)));
  return `${time.toFixed(digits)} s`;
}
