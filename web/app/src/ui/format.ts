// Numbers as people read them: digits and units by web/app/README.md. Nothing is computed here but units of time.

const minus = (text: string) => text.replace("-", "−");

/// Returns a number with that many decimals, or "unknown".
export function number(value: number | null | undefined, decimals: number): string {
  return value == null || !Number.isFinite(value) ? "unknown" : minus(value.toFixed(decimals).replace(/^-(0(\.0*)?)$/, "$1"));
}

/// Returns a number with its unit, "16.2 %", or "unknown".
export function quantity(value: number | null | undefined, decimals: number, unit: string): string {
  const text = number(value, decimals);
  return text === "unknown" ? text : `${text} ${unit}`;
}

/// Returns "21 min 29 s", from an hour on "1 h 12 min"; to the nearest second.
export function duration(seconds: number | null | undefined): string {
  if (seconds == null || !Number.isFinite(seconds)) return "unknown";
  const whole = Math.round(Math.abs(seconds));
  const sign = seconds < 0 && whole > 0 ? "−" : "";
  if (whole >= 3600) return `${sign}${Math.floor(whole / 3600)} h ${Math.floor((whole % 3600) / 60)} min`;
  if (whole >= 60) return `${sign}${Math.floor(whole / 60)} min ${whole % 60} s`;
  return `${sign}${whole} s`;
}

/// Returns "4.1 km", or below a kilometre "830 m".
export function distance(metres: number | null | undefined): string {
  if (metres == null || !Number.isFinite(metres)) return "unknown";
  return Math.abs(metres) < 1000 ? quantity(metres, 0, "m") : quantity(metres / 1000, 1, "km");
}

/// Returns the number above 0 that a person typed, with a point or a comma for decimals, or null. In a number of whole
/// units, as metres from home, three digits behind it are thousands: "1,500" is not 1.5.
export function typed(text: string, is_whole = false): number | null {
  const plain = text.trim();
  const is_grouped = is_whole && /^[1-9]\d{0,2}(?:[.,'’\s]\d{3})+$/.test(plain);
  const value = Number(is_grouped ? plain.replace(/\D/g, "") : plain.replace(",", "."));
  return Number.isFinite(value) && value > 0 ? value : null;
}

/// Returns a chance in words, from a probability of 0 to 1: "95 of 100", "over 99 of 100", "under 1 of 100".
export function chance(probability: number | null | undefined): string {
  if (probability == null || !Number.isFinite(probability)) return "unknown";
  if (probability < 0.01) return "under 1 of 100";
  if (probability > 0.99) return "over 99 of 100";
  // What is wanted is 95 of 100: less does not read as that.
  const of_100 = probability < 0.95 ? Math.min(94, Math.round(100 * probability)) : Math.round(100 * probability);
  return `${of_100} of 100`;
}

/// Returns the date of "2020-07-03T12:17:45Z" as "3 July 2020", with the time of day if there is one.
export function date(iso: string | null | undefined): string {
  if (!iso) return "no date";
  const [day, time] = iso.split(/[T ]/);
  const at = new Date(`${day}T00:00:00Z`);
  if (Number.isNaN(at.getTime())) return iso;
  const text = at.toLocaleDateString("en-GB", { day: "numeric", month: "long", year: "numeric", timeZone: "UTC" });
  return time ? `${text}, ${time.slice(0, 5)}` : text;
}

/// Compares two names so that "flight 10" follows "flight 9".
export const naturally = new Intl.Collator("en", { numeric: true, sensitivity: "base" }).compare;

/// Returns "413 W", or below 100 W with one decimal "27.3 W".
export const power = (watts: number | null | undefined) => quantity(watts, watts != null && Math.abs(watts) >= 99.95 ? 0 : 1, "W");

/// Returns "5.02 Wh".
export const energy = (watt_hours: number | null | undefined) => quantity(watt_hours, 2, "Wh");
