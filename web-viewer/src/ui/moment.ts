/** m:ss, h:mm:ss; parts of a second are cut off. */
export function clockTime(seconds: number): string {
  const whole = Math.max(0, Math.floor(seconds));
  const two = (value: number): string => String(value).padStart(2, "0");
  const hours = Math.floor(whole / 3600);
  const minutes = Math.floor(whole / 60) % 60;
  return hours > 0 ? `${hours}:${two(minutes)}:${two(whole % 60)}` : `${minutes}:${two(whole % 60)}`;
}

/** A moment of a recording that lasts so long, s. */
export function moment(time: number, lasts: number): string {
  if (lasts >= 60) return clockTime(time);
  const digits = lasts >= 1 || lasts <= 0 ? 2 : Math.min(9, 2 - Math.floor(Math.log10(lasts)));
  return `${time.toFixed(digits)} s`;
}
